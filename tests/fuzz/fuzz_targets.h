// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace pelage {

// One function per reader: takes any bytes, and returns when the reader has accepted them or refused them
// with a pelage::Error. Everything else (another exception, a crash, what a sanitizer finds, an accepted
// input that breaks a promise) ends the program. The same functions serve coverage-guided fuzzing
// (PELAGE_FUZZ) and the replay of a generated corpus in plain ctest (replay_test.cpp).

void fuzz_hair(std::span<const uint8_t> bytes);
void fuzz_tfx(std::span<const uint8_t> bytes);
void fuzz_obj(std::span<const uint8_t> bytes);
void fuzz_hdr(std::span<const uint8_t> bytes);
void fuzz_exr(std::span<const uint8_t> bytes);
/// A photometric file, and the profile of a lamp that it makes.
void fuzz_ies(std::span<const uint8_t> bytes);
/// Both tools of post/ on an EXR, within a small budget.
void fuzz_post(std::span<const uint8_t> bytes);
/// The arguments of a procedural, which a renderer passes on from a RIB file.
void fuzz_request(std::span<const uint8_t> bytes);
/// The text of a scene, through YAML and every schema; no asset is read.
void fuzz_scene(std::span<const uint8_t> bytes);

/// A file of a content store, and what `pelage info` says of it.
void fuzz_cache(std::span<const uint8_t> bytes);
/// A checkpoint, as it is and as if its checksums were right.
void fuzz_checkpoint(std::span<const uint8_t> bytes);
/// A leaf of an operator cache, as if its checksum were right; and a layer of one.
void fuzz_leaf(std::span<const uint8_t> bytes);

/// The nodes and leaves of a fur tree, and rays through them.
void fuzz_fur(std::span<const uint8_t> bytes);

/// A file of chunks of fur, as it is and as if its checksums were right, and rays through what it holds.
void fuzz_chunks(std::span<const uint8_t> bytes);

/// A RIB file: its strands, skins and lights, and the scene that it makes.
void fuzz_rib(std::span<const uint8_t> bytes);

/// A USD file as text: its strands, its mesh, and what is found in it.
void fuzz_usd(std::span<const uint8_t> bytes);
/// An Alembic file, in the same ways.
void fuzz_alembic(std::span<const uint8_t> bytes);

/// A file of this process that holds `bytes`; its name ends in `ending`.
std::filesystem::path fuzz_file(std::span<const uint8_t> bytes, const std::string& ending);

}  // namespace pelage
