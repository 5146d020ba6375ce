// SPDX-License-Identifier: Apache-2.0
#include "geom/io/strand_formats.h"

namespace pelage {

HeldStrands::HeldStrands(const std::string& name, const char* format_name,
                         std::shared_ptr<const Strands> strands, bool root_uv)
    : RawStrands(name, strands->basis(), format_name),
      strands_(std::move(strands)),
      root_uv_(root_uv && !strands_->arrays().root_uv.empty()) {
  strand_count = strands_->strand_count();
  has_widths = true;
  for (const StrandAttribute& attribute : strands_->attributes()) {
    attributes.push_back(attribute);
    if (attribute.frequency != AttributeClass::kConstant) attributes.back().values.clear();
  }
}

HeldStrands::HeldStrands(const std::string& name, const char* format_name, std::shared_ptr<Strands> own)
    : HeldStrands(name, format_name, std::shared_ptr<const Strands>(own), true) {
  own_ = std::move(own);
}

HeldStrands::HeldStrands(const std::filesystem::path& path, const char* format_name, CurvesFile read)
    : HeldStrands(path.string(), format_name, std::make_shared<Strands>(std::move(read.strands))) {
  has_widths = read.has_widths;
  warnings = std::move(read.warnings);
}

StrandArrays HeldStrands::take_all() { return own_ ? std::move(*own_).release() : RawStrands::take_all(); }

uint32_t HeldStrands::first_point(size_t strand) const { return strands_->arrays().first_point[strand]; }

void HeldStrands::append(size_t begin, size_t end, FileWindows&, StrandArrays& a) const {
  append_places(*this, begin, end, a);
  const size_t from = first_point(begin), to = first_point(end);
  const auto points = strands_->points().subspan(from * 4, (to - from) * 4);
  a.points.insert(a.points.end(), points.begin(), points.end());
  if (root_uv_) {
    const auto uv = std::span(strands_->arrays().root_uv).subspan(begin, end - begin);
    a.root_uv.insert(a.root_uv.end(), uv.begin(), uv.end());
  }
  for (size_t i = 0; i < a.attributes.size(); ++i) {
    const StrandAttribute& source = strands_->attributes()[i];
    if (source.frequency == AttributeClass::kConstant) continue;
    const bool per_point = source.frequency == AttributeClass::kPerPoint;
    const auto n = static_cast<size_t>(source.components);
    const auto values =
        std::span(source.values)
            .subspan((per_point ? from : begin) * n, (per_point ? to - from : end - begin) * n);
    a.attributes[i].values.insert(a.attributes[i].values.end(), values.begin(), values.end());
  }
}

}  // namespace pelage
