// SPDX-License-Identifier: Apache-2.0
#include "base/content_store.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/check.h"
#include "base/error.h"
#include "base/lease.h"
#include "base/stored_file_layout.h"
#include "base/temporary_file.h"

namespace pelage {

namespace format = stored_file_format;

namespace {

/// Name of an environment variable. Its value lists folders, separated by ':'. In these folders, cache files
/// that other users wrote are accepted.
constexpr const char* kSharedCachesVariable = "PELAGE_SHARED_CACHES";

/// Returns whether the variable lists `folder` or a folder that contains it; both paths are compared without
/// symbolic links. A scene cannot declare a folder as shared, because the scene may come from the very users
/// whose files would then be trusted. The environment is set by the user or the farm.
bool is_shared_folder(const std::filesystem::path& folder) {
  const char* named = std::getenv(kSharedCachesVariable);
  if (!named) return false;
  std::error_code error;
  const std::filesystem::path place = std::filesystem::canonical(folder, error);
  if (error) return false;
  std::istringstream list(named);
  for (std::string name; std::getline(list, name, ':');) {
    if (name.empty()) continue;
    const std::filesystem::path shared = std::filesystem::canonical(name, error);
    if (error) continue;
    const auto [end, ignored] = std::mismatch(shared.begin(), shared.end(), place.begin(), place.end());
    if (end == shared.end()) return true;
  }
  return false;
}

}  // namespace

StoredFile::StoredFile(const OpenFile& file) : file_(file) {
  const std::filesystem::path& path = file.path();
  const std::span<const std::byte> bytes = file_.bytes();
  const StoredFileLayout layout =
      StoredFileLayout::read(path, bytes.size(), [&](uint64_t offset, std::span<std::byte> out) {
        std::memcpy(out.data(), bytes.data() + offset, out.size());
      });
  kind_ = layout.kind;
  key_ = layout.key;
  // The padding between parts must be zero, so that every byte of the file is verified.
  uint64_t end = sizeof(format::Header);
  const auto padded_to = [&](uint64_t next) {
    if (next < end || next - end >= format::kAlignment) return false;
    const auto gap = bytes.subspan(end, next - end);
    return std::all_of(gap.begin(), gap.end(), [](std::byte b) { return b == std::byte{0}; });
  };
  for (const format::Section& section : layout.sections) {
    if (!padded_to(section.offset)) refuse_stored_file(path, "unknown bytes between its sections");
    end = section.offset + section.bytes;
    sections_.push_back(bytes.subspan(section.offset, section.bytes));
    if (content_hash(sections_.back()) != ContentHash{section.hash_low, section.hash_high})
      refuse_stored_file(path, "its content does not match its checksum");
  }
  if (!padded_to(layout.table_offset)) refuse_stored_file(path, "unknown bytes between its sections");
}

bool is_stored_file(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  uint64_t magic = 0;
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(&magic), sizeof(magic));
  return file.gcount() == sizeof(magic) && magic == format::kMagic;
}

namespace {

/// Updates the time only when it is outdated, because writing costs more than reading; minutes do not matter.
void mark_used(const OpenFile& file) {
  struct stat info {};
  if (::fstat(file.descriptor(), &info) == 0 && std::time(nullptr) - info.st_mtime > 3600)
    ::futimens(file.descriptor(), nullptr);
}

/// Time since a file, which must not be a link, was written or used.
std::optional<std::chrono::seconds> unused_for(const std::filesystem::path& path) {
  struct stat info {};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  return std::chrono::seconds(std::time(nullptr) - info.st_mtime);
}

/// Whether a file has the name of an entry: kind, '-', 32 hexadecimal digits, ending.
bool is_entry_name(const std::string& name) {
  const size_t digits = 32, ending = std::strlen(format::kEnding);
  if (name.size() < digits + ending + 2 || !name.ends_with(format::kEnding)) return false;
  const std::string hash = name.substr(name.size() - ending - digits, digits);
  return name[name.size() - ending - digits - 1] == '-' && parse_hash(hash).has_value() && name[0] != '.';
}

}  // namespace

std::filesystem::path ContentStore::file(const std::string& kind, const ContentHash& key) const {
  return folder_ / (kind + "-" + to_string(key) + format::kEnding);
}

bool ContentStore::trusts(uid_t owner) const {
  return owner == ::geteuid() || owner == 0 || is_shared_folder(folder_);
}

template <class File>
std::optional<File> ContentStore::open_as(const std::string& kind, const ContentHash& key,
                                          const WarningSink& warn) const {
  const std::filesystem::path path = file(kind, key);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::symlink_status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return {};
  try {
    OpenFile file(path, OpenFile::Links::kRefuse);
    if (!trusts(file.owner())) {
      warn(fmt::format("{}: another user wrote this file; it is made again ({} names folders to share)",
                       path.string(), kSharedCachesVariable));
      return {};
    }
    mark_used(file);
    File stored(std::move(file));
    if (stored.kind() != kind || stored.key() != key) {
      warn(path.string() + ": the content does not match the file name; it is made again");
      return {};
    }
    return stored;
  } catch (const Error& e) {
    // Removed by another process between the check and the opening: the same as missing.
    if (std::filesystem::exists(path, error)) warn(std::string(e.what()) + "; it is made again");
    return {};
  }
}

std::optional<StoredFile> ContentStore::open(const std::string& kind, const ContentHash& key,
                                             const WarningSink& warn) const {
  return open_as<StoredFile>(kind, key, warn);
}

std::optional<StoredSections> ContentStore::open_sections(const std::string& kind, const ContentHash& key,
                                                          const WarningSink& warn) const {
  return open_as<StoredSections>(kind, key, warn);
}

ContentStore::Writer::Writer(const std::filesystem::path& path, const std::string& kind,
                             const ContentHash& key) {
  PELAGE_CHECK(kind.size() <= sizeof(format::Header::kind));
  attempt([&] { file_.emplace(path, Links::kReplace); });
  format::Header header;
  std::memcpy(header.kind, kind.data(), kind.size());
  header.key_low = key.low;
  header.key_high = key.high;
  put(std::as_bytes(std::span(&header, 1)));
}

void ContentStore::Writer::attempt(const std::function<void()>& step) {
  if (!failure_.empty()) return;
  try {
    step();
  } catch (const Error& e) {
    failure_ = e.what();
    file_.reset();
  }
}

void ContentStore::Writer::put(std::span<const std::byte> bytes) {
  written_ += bytes.size();
  attempt([&] { file_->write(bytes); });
}

void ContentStore::Writer::add(std::span<const std::byte> section) {
  static constexpr std::byte kZeros[format::kAlignment] = {};
  put(std::span(kZeros).first((format::kAlignment - written_ % format::kAlignment) % format::kAlignment));
  sections_.push_back({written_, section.size(), content_hash(section)});
  put(section);
}

bool ContentStore::Writer::commit(const WarningSink& warn) {
  std::vector<format::Section> table;
  for (const Section& s : sections_) table.push_back({s.offset, s.bytes, s.hash.low, s.hash.high});
  static constexpr std::byte kZeros[format::kAlignment] = {};
  put(std::span(kZeros).first((format::kAlignment - written_ % format::kAlignment) % format::kAlignment));
  format::Trailer trailer;
  trailer.table_offset = written_;
  trailer.section_count = table.size();
  trailer.file_bytes = written_ + table.size() * sizeof(format::Section) + sizeof(format::Trailer);
  const ContentHash hash = content_hash(std::as_bytes(std::span(table)));
  trailer.table_low = hash.low;
  trailer.table_high = hash.high;
  put(std::as_bytes(std::span(table)));
  put(std::as_bytes(std::span(&trailer, 1)));
  attempt([&] { file_->commit(); });
  file_.reset();
  if (!failure_.empty()) warn(failure_ + "; the result is not stored");
  return failure_.empty();
}

ContentStore::Writer ContentStore::writer(const std::string& kind, const ContentHash& key) const {
  return Writer(file(kind, key), kind, key);
}

bool ContentStore::store(const std::string& kind, const ContentHash& key,
                         std::span<const std::span<const std::byte>> sections,
                         const WarningSink& warn) const {
  Writer entry = writer(kind, key);
  for (const std::span<const std::byte>& section : sections) entry.add(section);
  return entry.commit(warn);
}

ContentStore::Lock::Lock(std::unique_ptr<Lease> lease) : lease_(std::move(lease)) {}
ContentStore::Lock::Lock(Lock&&) noexcept = default;
ContentStore::Lock::~Lock() = default;

ContentStore::Lock ContentStore::lock(const std::string& kind, const ContentHash& key,
                                      const std::function<bool()>& cancelled,
                                      std::chrono::milliseconds patience) const {
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  const std::string name = "." + kind + "-" + to_string(key) + format::kLockEnding;
  return Lock(Lease::take(folder_ / name, cancelled, patience));
}

ContentStore::Removed ContentStore::remove_unused(const std::filesystem::path& file,
                                                  std::chrono::seconds age) {
  if (!is_entry_name(file.filename().string())) return {};
  const auto unused = unused_for(file);
  if (!unused || *unused <= age) return {};
  std::error_code failed;
  const uint64_t bytes = std::filesystem::file_size(file, failed);
  if (failed || !std::filesystem::remove(file, failed)) return {};
  return {1, bytes};
}

std::vector<std::filesystem::path> ContentStore::entries() const {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder_, error), end; !error && at != end;
       at.increment(error)) {
    if (is_entry_name(at->path().filename().string())) found.push_back(at->path());
  }
  return found;
}

ContentStore::Removed ContentStore::prune(std::chrono::seconds age,
                                          std::span<const std::filesystem::path> keep) const {
  Removed removed;
  for (const std::filesystem::path& file : entries()) {
    const bool kept =
        std::any_of(keep.begin(), keep.end(), [&](const auto& k) { return k.filename() == file.filename(); });
    if (kept) continue;
    const Removed one = remove_unused(file, age);
    removed.files += one.files;
    removed.bytes += one.bytes;
  }
  return removed;
}

ContentStore::Removed ContentStore::shrink(uint64_t max_bytes) const {
  struct Entry {
    std::chrono::seconds unused;
    uint64_t bytes;
    std::filesystem::path file;
  };
  std::vector<Entry> found;
  uint64_t sum = 0;
  for (std::filesystem::path& file : entries()) {
    std::error_code error;
    const auto unused = unused_for(file);
    const uint64_t bytes = std::filesystem::file_size(file, error);
    if (!unused || error) continue;
    sum += bytes;
    found.push_back({*unused, bytes, std::move(file)});
  }
  std::sort(found.begin(), found.end(), [](const Entry& a, const Entry& b) {
    return a.unused != b.unused ? a.unused > b.unused : a.file < b.file;
  });
  Removed removed;
  for (const Entry& entry : found) {
    if (sum <= max_bytes) break;
    std::error_code failed;
    if (!std::filesystem::remove(entry.file, failed)) continue;
    sum -= entry.bytes;
    ++removed.files;
    removed.bytes += entry.bytes;
  }
  return removed;
}

void ContentStore::sweep(std::chrono::seconds age) const {
  sweep_temporaries(folder_);
  std::error_code error;
  std::vector<std::filesystem::path> old;
  for (std::filesystem::directory_iterator at(folder_, error), end; !error && at != end;
       at.increment(error)) {
    const std::string name = at->path().filename().string();
    // Temporary files may belong to another machine that is still writing.
    if (name.starts_with(kTemporaryPrefix)) continue;
    if (!name.starts_with('.') || !(name.ends_with(format::kEnding) || name.ends_with(format::kLockEnding)))
      continue;
    const auto unused = unused_for(at->path());
    if (unused && *unused > age) old.push_back(at->path());
  }
  for (const std::filesystem::path& path : old) std::filesystem::remove(path, error);
}

}  // namespace pelage
