// SPDX-License-Identifier: Apache-2.0
#include "view/requests.h"

#include <set>

#include <gtest/gtest.h>

namespace pelage {
namespace {

TEST(RequestRules, OnlyOwnPagesWithTheTokenAreAnswered) {
  const RequestRules rules("127.0.0.1", 8123, "secret");
  EXPECT_EQ(rules.status({"GET", "127.0.0.1:8123", "", "secret"}), 200);
  EXPECT_EQ(rules.status({"HEAD", "localhost:8123", "", "secret"}), 200);
  EXPECT_EQ(rules.status({"GET", "127.0.0.1:8123", "http://127.0.0.1:8123", "secret"}), 200);

  for (const char* token : {"", "secre", "secret2", "Secret"})
    EXPECT_EQ(rules.status({"GET", "127.0.0.1:8123", "", token}), 403) << token;
  for (const char* host : {"", "127.0.0.1", "127.0.0.1:80", "evil.example:8123", "127.0.0.1:8123:8123",
                           "127.0.0.1.evil.example:8123", ":8123", "192.168.0.1:8123"})
    EXPECT_EQ(rules.status({"GET", host, "", "secret"}), 403) << host;
  for (const char* origin : {"null", "http://evil.example", "https://127.0.0.1:8123", "http://127.0.0.1:81",
                             "http://localhost:8123"})
    EXPECT_EQ(rules.status({"GET", "127.0.0.1:8123", origin, "secret"}), 403) << origin;
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "get", ""})
    EXPECT_EQ(rules.status({method, "127.0.0.1:8123", "", "secret"}), 405) << method;
}

TEST(RequestRules, ACommandIsPlainJson) {
  const RequestRules rules("127.0.0.1", 8123, "secret");
  EXPECT_EQ(rules.status({"POST", "127.0.0.1:8123", "", "secret", "application/json", true}), 200);
  EXPECT_EQ(rules.status({"POST", "127.0.0.1:8123", "", "secret", "application/json", false}), 411);
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"})
    EXPECT_EQ(rules.status({"POST", "127.0.0.1:8123", "", "secret", type, true}), 415) << type;
  EXPECT_EQ(rules.status({"POST", "127.0.0.1:8123", "", "secre", "application/json", true}), 403);
  EXPECT_EQ(rules.status({"POST", "127.0.0.1:8123", "null", "secret", "application/json", true}), 403);
}

TEST(RequestRules, AllAddressesMeanNumbersOnly) {
  const RequestRules rules("0.0.0.0", 80, "secret");
  for (const char* host : {"192.168.0.7:80", "localhost:80", "[fe80::1]:80", "0.0.0.0:80"})
    EXPECT_EQ(rules.status({"GET", host, "", "secret"}), 200) << host;
  for (const char* host : {"evil.example:80", "abc:80", "1.2.3.4x:80"})
    EXPECT_EQ(rules.status({"GET", host, "", "secret"}), 403) << host;
}

TEST(RandomToken, IsLongAndNew) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
}

}  // namespace
}  // namespace pelage
