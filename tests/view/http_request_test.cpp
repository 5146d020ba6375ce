// SPDX-License-Identifier: Apache-2.0
#include "view/http_request.h"

#include <gtest/gtest.h>

namespace pelage {
namespace {

using Parameters = std::vector<std::pair<std::string, std::string>>;

HttpRequest target(std::string_view text) {
  HttpRequest request;
  read_target(text, request);
  return request;
}

TEST(HttpRequest, ATargetIsDecoded) {
  const HttpRequest request = target("/a+b%20c?name=key+light&name=%2B%41&token=&x&=1&&y=1=2");
  EXPECT_EQ(request.path, "/a+b c");
  EXPECT_EQ(request.parameters, (Parameters{{"name", "key light"},
                                            {"name", "+A"},
                                            {"token", ""},
                                            {"x", ""},
                                            {"", "1"},
                                            {"", ""},
                                            {"y", "1=2"}}));
  EXPECT_EQ(request.parameter("name"), "key light");
  EXPECT_EQ(request.parameter("none"), "");
}

TEST(HttpRequest, WhatIsNoCodeStays) {
  EXPECT_EQ(target("/%zz%4%").path, "/%zz%4%");
  EXPECT_EQ(target("/%+1%-1% 1").path, "/%+1%-1% 1");
  EXPECT_EQ(target("/a%00b").path, std::string("/a\0b", 4));
  for (const char* text : {"", "*", "http://127.0.0.1/state.json", "state.json"})
    EXPECT_EQ(target(text).path, "") << text;
  EXPECT_EQ(target("/?").parameters, Parameters());
}

}  // namespace
}  // namespace pelage
