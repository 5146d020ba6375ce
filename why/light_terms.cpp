// SPDX-License-Identifier: Apache-2.0
#include "why/light_terms.h"

#include <algorithm>

#include "base/check.h"

namespace pelage {

std::vector<LightTerm> light_terms(const Film& film, const LightSet& lights, int x, int y) {
  const FilmLayers& layers = film.layers();
  PELAGE_CHECK(layers.events && layers.lights() == lights.size());
  std::vector<LightTerm> terms;
  for (size_t light = 0; light < lights.size(); ++light) {
    const std::string name = lights.light(light).name();
    for (int group = 0; group < layers.groups; ++group) {
      const size_t all = layers.scattered(light, group);
      const std::string lobe = layers.names[all].substr(name.size() + 1);
      const Rgb direct = film.layer(x, y, layers.direct(light, group));
      terms.push_back({name, lobe, "direct", direct});
      terms.push_back({name, lobe, "indirect", film.layer(x, y, all) - direct});
    }
    if (lights.light(light).visible())
      terms.push_back({name, "emission", "", film.layer(x, y, layers.emitted(light))});
  }
  std::stable_sort(terms.begin(), terms.end(), [](const LightTerm& a, const LightTerm& b) {
    return luminance(a.radiance) > luminance(b.radiance);
  });
  return terms;
}

}  // namespace pelage
