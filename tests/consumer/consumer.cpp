// SPDX-License-Identifier: Apache-2.0
// consumer SCENE OUT.exr: renders the first frame of a scene.
#include <cstdio>

#include "base/error.h"
#include "base/stopwatch.h"
#include "world/world.h"

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "usage: consumer SCENE OUT.exr\n");
    return 2;
  }
  const pelage::Workers workers;  // a thread per processor
  pelage::MemoryLedger ledger;
  pelage::NoProgress progress;  // or a Progress of your own, which can also cancel
  const pelage::Job job{workers, ledger, progress};
  const pelage::Stopwatch clock;

  const pelage::SceneDescription scene = pelage::load_scene(argv[1]);
  const auto assets = pelage::load_assets(scene, job);
  const pelage::World world = pelage::compose(scene, *assets, scene.frames.frames.front(), job);
  const pelage::FrameResult result = pelage::render(world, job);
  pelage::write_frame(argv[2], world, result, clock.seconds(), job);
  std::printf("%s: %lld strands\n", argv[2], static_cast<long long>(world.counts.strands_described));
} catch (const pelage::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
