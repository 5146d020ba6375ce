// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <zlib.h>

#include "base/error.h"
#include "base/file.h"
#include "base/temporary_folder.h"
#include "rib/syntax/rib_reader.h"

namespace pelage::rib_test {

/// Files of one test.
struct Files {
  TemporaryFolder folder;
  std::filesystem::path write(const std::string& bytes, const std::string& name = "a.rib") const {
    write_file(folder.path() / name, bytes);
    return folder.path() / name;
  }
};

/// All statements of a file with this text.
inline std::vector<RibStatement> statements_of(const std::string& text) {
  const Files files;
  RibReader reader(files.write(text));
  std::vector<RibStatement> all;
  RibStatement one;
  while (reader.next(one)) {
    one.file = "a.rib";
    all.push_back(one);
  }
  return all;
}

inline std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

inline std::string big_endian(uint64_t value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += static_cast<char>(value >> (8 * i) & 0xff);
  return out;
}

inline std::string binary_float(float value) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, 4);
  return big_endian(bits, 4);
}

/// A binary array of floats.
inline std::string binary_floats(const std::vector<float>& values) {
  std::string out = "\xcb" + big_endian(values.size(), 4);
  for (const float v : values) out += binary_float(v);
  return out;
}

/// The message of the Error that `run` throws; "no error" if it throws none.
template <class Run>
std::string error_of(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.kind() == ErrorKind::kInput ? error.what() : std::string("another kind: ") + error.what();
  }
  return "no error";
}

}  // namespace pelage::rib_test
