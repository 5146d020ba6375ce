// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/exr.h"
#include "render/film/film.h"

namespace pelage {

/// What is written of a film, whole.
inline ExrImage picture_of(const Film& film) {
  return {film.width(), film.height(), film.exr_rows(0, film.height()), {}};
}

}  // namespace pelage
