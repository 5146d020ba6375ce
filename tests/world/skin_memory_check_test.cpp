// SPDX-License-Identifier: Apache-2.0
#include "world/skin_memory_check.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "tests/geom/cages.h"

namespace pelage {
namespace {

struct WarningLog final : Progress {
  void begin(std::string_view, double) override {}
  void advance(double) override {}
  void end() override {}
  void warn(std::string_view line) override { text += line; }
  bool cancelled() const override { return false; }
  std::string text;
};

class SkinMemoryCheckTest : public testing::Test {
 protected:
  SkinParams params(SubdivisionScheme scheme) const {
    SkinParams params;
    params.mesh = {"meshes/scan.obj", {"scene.yaml", 3, 20}};
    params.scheme = scheme;
    return params;
  }

  const Workers workers_{1};
  MemoryLedger ledger_;
  WarningLog progress_;
  const Job job_{workers_, ledger_, progress_};
};

TEST_F(SkinMemoryCheckTest, DenseMeshesAreToldOfSchemeNone) {
  const ControlMesh dense = bumpy_sphere(103), sparse = bumpy_sphere(90);
  reserve_skin("bust", params(SubdivisionScheme::kCatmullClark), sparse, job_);
  reserve_skin("bust", params(SubdivisionScheme::kNone), dense, job_);
  EXPECT_EQ(progress_.text, "");
  reserve_skin("bust", params(SubdivisionScheme::kCatmullClark), dense, job_);
  EXPECT_EQ(progress_.text.find("scene.yaml:3:20: skin 'bust' with the 21012 faces of scan.obj"), 0u)
      << progress_.text;
  EXPECT_NE(progress_.text.find("scheme: none uses the polygons as they are"), std::string::npos);
}

TEST_F(SkinMemoryCheckTest, WhatDoesNotFitIsRefusedByName) {
  const ControlMesh mesh = bumpy_sphere(103);
  ledger_.set_limit(int64_t(64) << 20);
  {
    const MemoryCharge charge = reserve_skin("bust", params(SubdivisionScheme::kNone), mesh, job_);
    EXPECT_GT(ledger_.current(MemoryTag::kSkins), 21012 * 50);
  }
  EXPECT_EQ(ledger_.budgeted(), 0);
  try {
    reserve_skin("bust", params(SubdivisionScheme::kCatmullClark), mesh, job_);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kMemory);
    const std::string text = error.what();
    for (const char* part : {"skin 'bust'", "scan.obj", "render.memory is 64.0 MiB", "scheme: none takes"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace pelage
