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

// The first object is the program itself; a value other than 0 ends the walk.
int look_at(dl_phdr_info* object, size_t, void* found) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    if (part.p_type != PT_NOTE) continue;
    const auto* notes = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    std::string id = build_id(notes, part.p_memsz);
    if (!id.empty()) *static_cast<std::string*>(found) = std::move(id);
  }
  return 1;
}

}  // namespace

std::string program_identity() {
  std::string id;
  ::dl_iterate_phdr(look_at, &id);
  if (!id.empty()) return id;
  try {
    return to_string(content_hash(MappedFile("/proc/self/exe").bytes()));
  } catch (const Error&) {
    return "unknown";
  }
}

}  // namespace pelage
