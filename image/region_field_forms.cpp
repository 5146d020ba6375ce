// SPDX-License-Identifier: Apache-2.0
#include "base/nearest_name.h"
#include "image/field_forms.h"

namespace pelage {
namespace {

struct RegionForm {
  std::string region;
  static const Schema<RegionForm>& schema();
};

const Schema<RegionForm>& RegionForm::schema() {
  static const Schema<RegionForm> table = [] {
    Schema<RegionForm> s("region field", "The field of a region of the scene, see `regions`.");
    s.set_example(R"(regions:
  spots: {threshold: {noise: {frequency: 1.5}}, at: 0}
grooms:
  coat:
    skin: patch
    strands: 20000
    operators:
      - length: {value: 0.8, mask: {region: spots}})");
    s.set_picture("Left: strands of length 0.4. Right: strands of length 0.8 in a region.");
    s.key("region", &RegionForm::region, {.help = "Name of the region", .required = true});
    return s;
  }();
  return table;
}

/// load_scene() has put the fields of regions in the places of their names, except where it reported a
/// problem; there, the name is empty.
bool read_region(const Value& value, const KeyOptions&, Field&, Problems& problems) {
  RegionForm form;
  if (!RegionForm::schema().read(value, form, problems)) return false;
  if (!form.region.empty())
    problems.add(value.find("region")->position(), "there is no region " + quote(form.region));
  return false;
}

constexpr FieldForm kRegionForms[] = {{"region", read_region, form_table<RegionForm>}};

}  // namespace

std::span<const FieldForm> region_field_forms() { return kRegionForms; }

}  // namespace pelage
