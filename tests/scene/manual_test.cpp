// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include <gtest/gtest.h>

#include "base/value_readers.h"
#include "scene/document.h"
#include "tests/scene/document_text.h"

namespace pelage {
namespace {

struct Lens {
  float f_stop = 8;
  static const Schema<Lens>& schema() {
    static const Schema<Lens> table = [] {
      Schema<Lens> s("lens", "Blurs what is out of focus.");
      s.key("f_stop", &Lens::f_stop, {.help = "Focal length over the diameter", .min = 0, .above_min = true});
      return s;
    }();
    return table;
  }
};

struct Camera {
  float fov = 40;
  std::optional<Lens> optics;
  Lens spare;
  static const Schema<Camera>& schema() {
    static const Schema<Camera> table = [] {
      Schema<Camera> s("camera", "Where it is seen from.");
      s.key("fov", &Camera::fov,
            {.unit = "degrees", .help = "Vertical angle | of view", .min = 0, .max = 180});
      s.key("optics", &Camera::optics, {.help = "Pinhole without"});
      s.key("spare", &Camera::spare, {.required = true});
      return s;
    }();
    return table;
  }
};

TEST(Manual, IsPlainText) {
  EXPECT_EQ(manual_text(Camera::schema()),
            "camera\n"
            "  Where it is seen from.\n"
            "\n"
            "  fov     number, 0 .. 180, degrees, default 40\n"
            "          Vertical angle | of view\n"
            "  optics  block lens, default none\n"
            "          Pinhole without\n"
            "          see lens\n"
            "  spare   block lens, required\n"
            "          see lens\n"
            "\n"
            "lens\n"
            "  Blurs what is out of focus.\n"
            "\n"
            "  f_stop  number, > 0, default 8\n"
            "          Focal length over the diameter\n");
}

TEST(Manual, IsMarkdown) {
  EXPECT_EQ(manual_text(Camera::schema(), "camera", true),
            "## camera\n"
            "\n"
            "Where it is seen from.\n"
            "\n"
            "| key | type | default | range | unit | |\n"
            "|---|---|---|---|---|---|\n"
            "| `fov` | number | 40 | 0 .. 180 | degrees | Vertical angle \\| of view. |\n"
            "| `optics` | block lens | none |  |  | Pinhole without. See [lens](#lens). |\n"
            "| `spare` | block lens | required |  |  | See [lens](#lens). |\n"
            "\n");
}

TEST(Manual, MarkdownLinksLeadToHeadings) {
  struct Named {
    Lens spare;
    static const Schema<Named>& schema() {
      static const Schema<Named> table = [] {
        Schema<Named> s("two words", "");
        s.key("self", &Named::spare, {});
        return s;
      }();
      return table;
    }
  };
  struct Root {
    Named block;
    static const Schema<Root>& schema() {
      static const Schema<Root> table = [] {
        Schema<Root> s("root", "");
        s.key("block", &Root::block, {});
        return s;
      }();
      return table;
    }
  };
  EXPECT_NE(manual_text(Root::schema(), "root", true).find("[two words](#two-words)"), std::string::npos);
}

TEST(Manual, ShowsExamplesPicturesAndFormerNames) {
  Schema<Lens> lens("thin lens", "Blurs.");
  lens.set_example("camera:\n  lens: {f_stop: 4}");
  lens.set_picture("Left: sharp. Right: blurred.");
  lens.key("f_stop", &Lens::f_stop, {.help = "Focal length over the diameter", .old_names = {"stop", "f"}});
  EXPECT_EQ(manual_text(lens),
            "thin lens\n"
            "  Blurs.\n"
            "\n"
            "  f_stop  number, default 8\n"
            "          Focal length over the diameter. Formerly `stop`, `f`.\n"
            "\n"
            "  Example:\n"
            "    camera:\n"
            "      lens: {f_stop: 4}\n");
  EXPECT_EQ(manual_text(lens, {}, true),
            "## thin lens\n"
            "\n"
            "Blurs.\n"
            "\n"
            "![Left: sharp. Right: blurred.](images/manual/thin_lens.png)\n"
            "\n"
            "Left: sharp. Right: blurred.\n"
            "\n"
            "```yaml\n"
            "camera:\n"
            "  lens: {f_stop: 4}\n"
            "```\n"
            "\n"
            "| key | type | default | range | unit | |\n"
            "|---|---|---|---|---|---|\n"
            "| `f_stop` | number | 8 |  |  | Focal length over the diameter. Formerly `stop`, `f`. |\n"
            "\n");
}

TEST(Manual, FindsSectionsByNameOrByKey) {
  const std::string lens = manual_text(Camera::schema(), "lens");
  EXPECT_EQ(lens.substr(0, 5), "lens\n");
  EXPECT_EQ(lens.find("camera"), std::string::npos);
  EXPECT_EQ(manual_text(Camera::schema(), "optics"), lens);
  EXPECT_EQ(error_lines([] { manual_text(Camera::schema(), "camra"); }),
            Lines{"the manual has no section 'camra'; did you mean 'camera'?"});
}

TEST(Manual, LinesFitATerminal) {
  const SchemaInfo wide("wide",
                        std::string(300, 'a') + " " + std::string(60, 'b') + " " + std::string(60, 'c'));
  const std::string text = manual_text(wide);
  EXPECT_NE(text.find(std::string(60, 'b') + "\n  " + std::string(60, 'c') + "\n"), std::string::npos);
}

}  // namespace
}  // namespace pelage
