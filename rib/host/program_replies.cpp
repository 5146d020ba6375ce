// SPDX-License-Identifier: Apache-2.0
#include "rib/host/program_replies.h"

#include <charconv>
#include <new>
#include <streambuf>

#include <fmt/format.h>

#include "base/nearest_name.h"
#include "rib/host/coat_rib.h"
#include "rib/syntax/rib_curves.h"

namespace pelage {
namespace {

constexpr std::string_view kEndOfReply = "\377";

/// Writes nodes and strands as requests.
class RibOutput final : public HairOutput {
 public:
  RibOutput(RibWriter& rib, const std::string& command) : rib_(rib), command_(command) {}
  void nested(HairNode node, const Box3f& bound) override {
    rib_.request("Procedural").text("RunProgram").texts({command_, print_hair_arguments(node.arguments)});
    write_bound(rib_, bound);
  }
  void strands(Strands strands, std::span<const float> times) override { write_curves(rib_, strands, times); }

 private:
  RibWriter& rib_;
  const std::string& command_;
};

}  // namespace

std::string one_line(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) return "out of memory";
  std::string text = error.what();
  const auto* ours = dynamic_cast<const Error*>(&error);
  if (ours && ours->problems().size() > 1)
    text = fmt::format("{} (and {} more)", text.substr(0, text.find('\n')), ours->problems().size() - 1);
  constexpr size_t kLongest = 1000;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

bool read_program_request(std::istream& input, std::string& request) {
  request.clear();
  std::streambuf& bytes = *input.rdbuf();
  using Traits = std::istream::traits_type;
  bool any = false;
  for (auto c = bytes.sbumpc(); !Traits::eq_int_type(c, Traits::eof()); c = bytes.sbumpc()) {
    any = true;
    if (c == '\n') break;
    if (request.size() <= kMaxProgramRequest) request += Traits::to_char_type(c);
  }
  return any;
}

std::string ProgramReplies::reply(std::string_view request, RibSink& sink) {
  RibText text;
  RibWriter rib(text, RibEncoding::kAscii);
  std::string error;
  try {
    while (request.ends_with('\n') || request.ends_with('\r')) request.remove_suffix(1);
    if (request.size() > kMaxProgramRequest)
      throw Error(ErrorKind::kArguments, "procedural: a request has more than 1 MiB");
    float detail = 0;
    const char* end = request.data() + request.size();
    const auto [rest, code] = std::from_chars(request.data(), end, detail);
    if (code == std::errc::invalid_argument)
      throw Error(ErrorKind::kArguments, "procedural: expected 'detail arguments', got " + quote(request));
    if (code == std::errc::result_out_of_range) detail = 1e38f;
    RibOutput output(rib, command_);
    subdivide_request(sessions_, {rest, static_cast<size_t>(end - rest)}, detail, output);
    rib.end_line();
    rib.flush();
  } catch (const std::exception& caught) {
    error = one_line(caught);
    text.clear();
  }
  sink.write(text.text());
  sink.write(kEndOfReply);
  return error;
}

}  // namespace pelage
