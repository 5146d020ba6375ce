// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace pelage {

/// Calls `feed` with damaged copies of `seed`: every truncation of the first 200 bytes and 60 longer ones,
/// `count` each of single flipped bytes, of 4-byte words replaced by numbers that break sizes and indices,
/// and of pieces moved elsewhere. The same ones every time.
void for_each_damaged(const std::string& seed, int count,
                      const std::function<void(const std::string&)>& feed);

/// Valid files to start from, and files made by hand to hurt.
std::vector<std::string> hair_corpus();
std::vector<std::string> tfx_corpus();
std::vector<std::string> obj_corpus();
std::vector<std::string> hdr_corpus();
std::vector<std::string> exr_corpus();
std::vector<std::string> ies_corpus();
std::vector<std::string> post_corpus();
std::vector<std::string> request_corpus();
std::vector<std::string> scene_corpus();
std::vector<std::string> cache_corpus();
std::vector<std::string> checkpoint_corpus();
std::vector<std::string> leaf_corpus();
std::vector<std::string> fur_corpus();
std::vector<std::string> chunks_corpus();
std::vector<std::string> rib_corpus();
std::vector<std::string> usd_corpus();
std::vector<std::string> alembic_corpus();

}  // namespace pelage
