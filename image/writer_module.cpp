// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include <OpenImageIO/imageio.h>

#include "image/reader_module.h"

namespace {

/// Empty on success.
std::string written(const char* path, int width, int height, const uint8_t* rgb) {
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
  if (!output) return OIIO::geterror();
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Compression", "jpeg:95");
  const bool good =
      output->open(path, spec) && output->write_image(OIIO::TypeDesc::UINT8, rgb) && output->close();
  return good ? "" : output->geterror();
}

}  // namespace

int pelage_write_image(const char* path, int width, int height, const uint8_t* rgb, char* message,
                       size_t message_size) {
  std::string problem;
  try {
    problem = written(path, width, height, rgb);
  } catch (const std::exception& error) {
    problem = error.what();
  } catch (...) {
    problem = "cannot be encoded";
  }
  if (problem.empty()) return 0;
  std::snprintf(message, message_size, "%s", problem.substr(0, problem.find('\n')).c_str());
  return 1;
}
