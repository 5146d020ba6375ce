// SPDX-License-Identifier: Apache-2.0
#include "view/view_server.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/hash.h"
#include "tests/support/effort.h"
#include "tests/view/http_client.h"
#include "tests/world/small_scene.h"

namespace pelage {
namespace {

/// A server for a picture of 3 x 2 pixels.
class ViewServerTest : public testing::Test {
 protected:
  ViewServerTest() {
    Picture picture;
    picture.width = 3;
    picture.height = 2;
    picture.full = {0, 0, 3, 2};
    picture.layers["beauty"] = {{"R", ChannelType::kHalf, std::vector<float>(6, 0.5f), {}}};
    state_.publish(std::move(picture));
    state_.update([](ViewStatus& status) { status.layers = {"beauty"}; });
    state_.why().on_ask([this] { state_.why().answer([](int, int) { return CommandAnswer{200, "{}"}; }); });
  }

  int port() const { return std::stoi(server_.url().substr(sizeof "http://127.0.0.1:" - 1)); }
  std::string token() const { return server_.url().substr(server_.url().find('=') + 1); }
  std::string request(const std::string& line, const std::string& rest = "\r\n") const {
    return line + (line.find('?') == std::string::npos ? "?" : "&") + "token=" + token() +
           " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port()) + "\r\n" + rest;
  }
  std::string get(const std::string& page, const std::string& headers = "") const {
    return http_answer(port(), request("GET /" + page, headers + "\r\n"));
  }
  std::string post(const std::string& page, const std::string& body) const {
    return request("POST /" + page, "Content-Type: application/json\r\nContent-Length: " +
                                        std::to_string(body.size()) + "\r\n\r\n" + body);
  }

  SmallScene scene_;
  ViewState state_;
  const SceneCommands commands_{scene_.path("scene.yaml"), {}, state_};
  const ViewServer server_{state_, commands_, "127.0.0.1", 0};
};

TEST_F(ViewServerTest, ARangeIsNeverMoreThanTheFile) {
  for (const char* page : {"", "main.js", "state.json", "layer.bin?name=beauty", "picture.exr"}) {
    const std::string whole = http_body(get(page));
    EXPECT_EQ(http_status(get(page)), 200) << page;
    EXPECT_EQ(http_body(get(page, "Range: bytes=0-90000\r\n")).size(), whole.size()) << page;
  }
}

TEST_F(ViewServerTest, PagesAreCounted) {
  const auto pages = [&](const char* query) {
    return nlohmann::json::parse(http_body(get(std::string("state.json") + query)))["pages"];
  };
  EXPECT_EQ(pages(""), 0);
  EXPECT_EQ(pages("?page=a"), 1);
  EXPECT_EQ(pages("?page=b"), 2);
  EXPECT_EQ(pages("?page=a"), 2);
  EXPECT_EQ(pages(("?page=" + std::string(1000, 'c')).c_str()), 2);
}

/// Returns a copy of a request with up to 8 random changes.
std::string damaged(const std::string& good, uint64_t seed) {
  std::string bytes = good;
  uint64_t draws = 0;
  const auto draw = [&](uint64_t end) { return hash64(seed, ++draws) % end; };
  const std::string pieces[] = {"\r\n\r\n", "%",  "%00",  "../", "999999999999999999999",
                                "-1",       "\0", "\xff", ":",   "bytes=0-90000"};
  for (uint64_t change = draw(8) + 1; change > 0; --change) {
    const size_t at = draw(bytes.size() + 1), size = draw(40) + 1;
    switch (draw(5)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(draw(256));
        break;
      case 1:
        bytes.erase(at, size);
        break;
      case 2:
        for (uint64_t copies = draw(40); copies > 0; --copies) bytes.insert(at, bytes.substr(at, size));
        break;
      case 3:
        bytes.insert(at, pieces[draw(std::size(pieces))]);
        break;
      default:
        bytes.insert(at, bytes.substr(draw(bytes.size() + 1), 10 * size));
    }
  }
  return bytes;
}

TEST_F(ViewServerTest, SurvivesDamagedHeadsAndBodies) {
  const std::string text = read_file(scene_.path("scene.yaml"));
  const std::string odd =
      "Range: bytes=0-5\r\nExpect: 100-continue\r\nTransfer-Encoding: chunked\r\nAccept-Encoding: gzip\r\n"
      "Content-Type: multipart/form-data; boundary=x\r\n\r\n5\r\nabcde\r\n0\r\n\r\n";
  const std::vector<std::string> good{
      request("GET /state.json"),
      request("GET /layer.bin?name=beauty&name=Z", odd),
      request("GET /picture.exr", "Range: bytes=1-2\r\n\r\n"),
      request("GET /why.json?x=1&y=x"),
      post("camera.json", R"({"action": "move", "position": [3, 2, 8], "look_at": [0, 0, 0]})"),
      post("lights.json",
           R"({"action": "text", "edit": 0, "lights": {"key": {"stops": 1, "tint": [1, 1, 1]}}})"),
      post("region.json", R"({"region": [0, 0, 2, 2]})"),
      post("frame.json", R"({"frame": 1})")};
  for (uint64_t seed = 0; seed < repetitions(4000); ++seed) {
    const std::string bytes = damaged(good[seed % good.size()], seed);
    const std::string answer = http_answer(port(), bytes);
    if (answer.empty()) continue;  // half a request
    ASSERT_GE(http_status(answer), 200) << bytes;
    ASSERT_LE(http_status(answer), 503) << bytes;
    const size_t length = answer.find("Content-Length: ");
    ASSERT_TRUE(length != std::string::npos || http_status(answer) == 204) << answer;
    if (length != std::string::npos && !bytes.starts_with("HEAD")) {
      ASSERT_EQ(http_body(answer).size(), std::stoul(answer.substr(length + 16))) << bytes;
    }
  }
  EXPECT_EQ(http_status(get("state.json")), 200);
  EXPECT_EQ(read_file(scene_.path("scene.yaml")), text);
}

}  // namespace
}  // namespace pelage
