// SPDX-License-Identifier: Apache-2.0
#include "render/frame/camera_samples.h"

#include "base/hash.h"
#include "render/accel/min_width.h"

namespace pelage {

CameraSamples::CameraSamples(const FrameScene& scene, const Accel& accel, bool splatted)
    : scene_(scene),
      opaque_(accel.opaque()),
      widens_(scene.render.min_width() > 0),
      place_(splatted ? PixelFilter::kBox : scene.image.filter) {}

SampleStream CameraSamples::stream(int x, int y, uint32_t sample) const {
  return {static_cast<uint64_t>(scene_.render.seed), static_cast<uint32_t>(x), static_cast<uint32_t>(y),
          sample};
}

CameraSample CameraSamples::sample(int x, int y, uint32_t sample, SampleStream& stream) const {
  CameraSample result;
  stream.seek(static_cast<uint32_t>(SampleDimension::kFilm));
  result.offset = place_.offset(stream.next2d());
  V2f lens(0.5f);
  float time = 0;
  if (scene_.camera.has_lens()) {
    stream.seek(static_cast<uint32_t>(SampleDimension::kLens));
    lens = stream.next2d();
  }
  if (scene_.camera.shutter_frames() > 0) {
    stream.seek(static_cast<uint32_t>(SampleDimension::kTime));
    time = scene_.camera.sampled_time(stream.next1d());
  }
  const CameraRay from = scene_.camera.ray(static_cast<float>(x) + 0.5f + result.offset.x,
                                           static_cast<float>(y) + 0.5f + result.offset.y, lens, time);
  result.ray.origin = from.origin;
  result.ray.direction = from.direction;
  result.ray.time = from.time;
  if (widens_) {
    const uint64_t pixel =
        hash64(static_cast<uint64_t>(scene_.render.seed), static_cast<uint32_t>(x), static_cast<uint32_t>(y),
               sample / MinWidth::kSamples, random_use("crossings"));
    result.ray.random = MinWidth::random_of(pixel, sample);
  } else if (!opaque_) {
    result.ray.random =
        static_cast<uint32_t>(hash64(static_cast<uint64_t>(scene_.render.seed), static_cast<uint32_t>(x),
                                     static_cast<uint32_t>(y), sample, random_use("crossings")));
  }
  return result;
}

}  // namespace pelage
