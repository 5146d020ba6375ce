// SPDX-License-Identifier: Apache-2.0
#include "exchange/hair_model.h"

#include <gtest/gtest.h>

#include "render/material/absorption.h"

namespace pelage::hair_model_test {
namespace {

TEST(HairModel, ChiangIsExact) {
  ExportNotes notes;
  ChiangParams p;
  p.absorption = Rgb(0.1f, 0.2f, 0.3f);
  p.beta_m = 0.2f, p.beta_n = 0.4f, p.alpha = 3, p.eta = 1.4f;
  const HairModel hair = hair_model(p, Rgb(0.5f), "fur", notes);
  EXPECT_EQ(hair.absorption, *p.absorption);
  EXPECT_EQ(hair.beta_m, 0.2f);
  EXPECT_EQ(hair.beta_n, 0.4f);
  EXPECT_EQ(hair.alpha, 3);
  EXPECT_EQ(hair.eta, 1.4f);
  EXPECT_TRUE(notes.empty());
  p.absorption.reset();
  EXPECT_EQ(hair_model(p, Rgb(0.5f, 0.3f, 0.1f), "fur", notes).absorption,
            ColorToAbsorption(0.4f)(Rgb(0.5f, 0.3f, 0.1f)));
}

TEST(HairModel, OtherModelsKeepTheWidthsOfLobes) {
  ExportNotes notes;
  DeonParams p;
  p.beta = 10, p.azimuthal_width = 15, p.alpha = -2;
  const HairModel hair = hair_model(p, Rgb(0.5f), "fur", notes);
  // The longitudinal lobe of deon has a standard deviation of beta.
  EXPECT_NEAR(std::sqrt(hair.longitudinal_variance()), 10 * M_PI / 180, 1e-4);
  EXPECT_NEAR(hair.azimuthal_scale() * std::sqrt(M_PI / 8) * M_PI / std::sqrt(3.0), 15 * M_PI / 180, 1e-4);
  EXPECT_EQ(hair.alpha, 2) << "the tilt of the scales is opposite to that of the highlight";
  EXPECT_FALSE(notes.empty());
}

TEST(HairModel, OpaqueModelsKeepTheColour) {
  ExportNotes notes;
  const HairModel hair = hair_model(ConeShellParams(), Rgb(0.4f, 0.2f, 0.1f), "fur", notes);
  EXPECT_EQ(hair.absorption, ColorToAbsorption(hair.beta_n)(Rgb(0.4f, 0.2f, 0.1f)));
  EXPECT_NE(notes.list().find("material 'fur': the model `cone-shell`"), std::string::npos);
}

}  // namespace
}  // namespace pelage::hair_model_test
