// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace pelage {

/// Receives the bytes of a RIB stream, in order. write() may throw Error (kFailed).
class RibSink {
 public:
  virtual ~RibSink() = default;
  virtual void write(std::string_view bytes) = 0;
};

/// Keeps the bytes in memory.
class RibText final : public RibSink {
 public:
  void write(std::string_view bytes) override { text_.append(bytes); }
  const std::string& text() const { return text_; }
  void clear() { text_.clear(); }

 private:
  std::string text_;
};

/// Compresses the bytes in gzip format and passes them to another sink, which must outlive this object. The
/// stream is complete only after finish().
class GzipSink final : public RibSink {
 public:
  explicit GzipSink(RibSink& to);
  ~GzipSink() override;
  void write(std::string_view bytes) override;
  /// Writes the end of the stream. Nothing may be written afterwards.
  void finish();

 private:
  struct Stream;
  void deflate(std::string_view bytes, bool last);
  RibSink& to_;
  std::unique_ptr<Stream> stream_;
};

}  // namespace pelage
