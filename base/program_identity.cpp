// SPDX-License-Identifier: Apache-2.0
#include "base/program_identity.h"

#include <cstring>
#include <span>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/mapped_file.h"

#if defined(__x86_64__) && defined(__GLIBC__)
#ifdef __clang__
#define _Bool bool  // the header is for C
#endif
#include <sys/platform/x86.h>
#endif

namespace pelage {
namespace {

// Notes are {name size, description size, type}, name, description, each padded to four bytes.
std::string build_id(const char* notes, size_t size) {
  size_t at = 0;
  while (at + sizeof(ElfW(Nhdr)) <= size) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes + at, sizeof(note));
    const size_t name = at + sizeof(note), description = name + (note.n_namesz + 3u) / 4 * 4;
    if (description + note.n_descsz > size) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(notes + name, "GNU", 4) == 0) {
      std::string text;
      for (size_t i = 0; i < note.n_descsz; ++i)
        text += fmt::format("{:02x}", static_cast<unsigned char>(notes[description + i]));
      return text;
    }
    at = description + (note.n_descsz + 3u) / 4 * 4;
  }
  return {};
}

std::string build_id(const dl_phdr_info& object) {
  std::string id;
  for (int i = 0; i < object.dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& part = object.dlpi_phdr[i];
    if (part.p_type != PT_NOTE) continue;
    id = build_id(reinterpret_cast<const char*>(object.dlpi_addr + part.p_vaddr), part.p_memsz);
  }
  return id;
}

/// The program or library that contains this code.
struct Own {
  std::string id;
  std::string file = "/proc/self/exe";  // the program has no name in the list of objects
};

bool contains(const dl_phdr_info& object, uintptr_t address) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object.dlpi_phdr[i];
    const uintptr_t begin = object.dlpi_addr + part.p_vaddr;
    if (part.p_type == PT_LOAD && address >= begin && address - begin < part.p_memsz) return true;
  }
  return false;
}

// A non-zero result ends the iteration.
int look_for_own(dl_phdr_info* object, size_t, void* found) {
  if (!contains(*object, reinterpret_cast<uintptr_t>(&look_for_own))) return 0;
  auto& own = *static_cast<Own*>(found);
  own.id = build_id(*object);
  if (object->dlpi_name && object->dlpi_name[0] != '\0') own.file = object->dlpi_name;
  return 1;
}

struct Wanted {
  std::string_view name;
  std::string id = "none";
};

int look_for(dl_phdr_info* object, size_t, void* data) {
  auto& wanted = *static_cast<Wanted*>(data);
  std::string_view file = object->dlpi_name;
  file.remove_prefix(file.rfind('/') + 1);  // npos + 1 is 0
  if (file.find(wanted.name) == std::string_view::npos) return 0;
  wanted.id = build_id(*object);
  if (wanted.id.empty()) wanted.id = "unknown";
  return 1;
}

}  // namespace

const char* instruction_set() {
#if defined(__x86_64__) && defined(__GLIBC__)
  // What the library uses, rather than what the processor has.
  return CPU_FEATURE_ACTIVE(FMA) && CPU_FEATURE_ACTIVE(AVX2) ? "x86-64 FMA" : "x86-64";
#elif defined(__aarch64__)
  return "aarch64";
#else
  return "unknown";
#endif
}

std::string library_identity(std::string_view name) {
  Wanted wanted{name};
  ::dl_iterate_phdr(look_for, &wanted);
  return wanted.id;
}

std::string arithmetic_identity() {
  std::string identity = __VERSION__;
#ifdef __OPTIMIZE__
  identity += " optimised";  // the compiler computes functions of constants itself
#endif
  // Only libraries that the program starts with: others are loaded with the module that reads textures, and
  // the identity must not depend on whether one has been read.
  for (const char* library : {"libm.so", "libosdCPU.so"}) identity += " " + library_identity(library);
  return identity + " " + instruction_set();
}

std::string program_identity() {
  Own own;
  ::dl_iterate_phdr(look_for_own, &own);
  if (!own.id.empty()) return own.id;
  try {
    return to_string(content_hash(MappedFile(own.file).bytes()));
  } catch (const Error&) {
    return "unknown";
  }
}

}  // namespace pelage
