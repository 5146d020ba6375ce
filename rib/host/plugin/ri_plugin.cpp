// SPDX-License-Identifier: Apache-2.0
//
// libpelage_ri.so: coats as procedurals of a RenderMan-compliant renderer, which finds the three functions
// below by their names [RISPEC 3.2, procedural primitives]. No exception leaves them.
#include <exception>
#include <string>

#include "rib/host/hair_node.h"
#include "rib/host/plugin/ri_host.h"
#include "rib/host/program_replies.h"

namespace {

using pelage::HairNode;
using pelage::HairOutput;
using pelage::RiHost;

// What the procedurals of a process share. A function, because the order in which a renderer loads and
// unloads libraries is not known; never destroyed, because threads of the renderer may outlive main().
struct Shared {
  RiHost host;
  pelage::HairSessions sessions;
};
Shared& shared() {
  static Shared* const one = new Shared;
  return *one;
}

void report(const char* what) noexcept {
  try {
    shared().host.error("pelage: error: " + std::string(what));
  } catch (...) {  // not even memory for the line
  }
}

/// Calls `work`; reports an exception as one line.
template <class Work>
void guarded(const Work& work) noexcept {
  try {
    work();
  } catch (const std::exception& error) {
    try {
      report(pelage::one_line(error).c_str());
    } catch (...) {
      report("out of memory");
    }
  } catch (...) {
    report("unknown exception");
  }
}

void subdivide_node(pelage::RtPointer data, pelage::RtFloat detail);
void free_node(pelage::RtPointer data) { delete static_cast<HairNode*>(data); }

class RiOutput final : public HairOutput {
 public:
  void nested(HairNode node, const pelage::Box3f& bound) override {
    shared().host.procedural(new HairNode(std::move(node)), bound, subdivide_node, free_node);
  }
  void strands(pelage::Strands strands, std::span<const float> times) override {
    shared().host.curves(std::move(strands), times);
  }
};

void subdivide_node(pelage::RtPointer data, pelage::RtFloat) {
  guarded([&] {
    RiOutput output;
    static_cast<const HairNode*>(data)->subdivide(output);
  });
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) pelage::RtPointer ConvertParameters(char* arguments) {
  pelage::RtPointer copy = nullptr;
  guarded([&] { copy = new std::string(arguments ? arguments : ""); });
  return copy;
}

__attribute__((visibility("default"))) void Subdivide(pelage::RtPointer data, pelage::RtFloat detail) {
  if (!data) return;  // ConvertParameters has reported why
  guarded([&] {
    RiOutput output;
    pelage::subdivide_request(shared().sessions, *static_cast<const std::string*>(data), detail, output);
  });
}

__attribute__((visibility("default"))) void Free(pelage::RtPointer data) {
  delete static_cast<std::string*>(data);
}
}
