// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace pelage {

/// How often the holder of a lease renews it, and when others consider it abandoned.
struct LeaseTiming {
  std::chrono::milliseconds renewal{5000};
  std::chrono::milliseconds expiry{30000};  ///< should be several renewals
};

/// The right to compute one result, which all processes and machines that share a folder respect. A lease is
/// a small file. Its holder creates it, writes a count into it at every renewal, and removes it at the end. A
/// process that waits reads the file again and again. When the count has not changed for the time `expiry`,
/// measured by the clock of the process that waits, the lease has expired: this process removes it and takes
/// it itself. Clocks of machines need not agree. If the holder was on the same machine and has died, its
/// lease is taken at once, because the system has released its lock (flock).
///
/// What the file system must guarantee: creating a file exclusively (O_EXCL) and renaming are atomic, and a
/// file that is opened shows what was flushed before (close-to-open consistency). NFS 3 and 4 and local
/// file systems do. Locks (flock) are not needed; without them, a dead holder on the same machine is noticed
/// after `expiry`.
///
/// In rare cases, two processes hold a lease at once: if the holder was suspended for longer than `expiry`,
/// or if two processes find at the same moment that it has expired. So a lease saves work but protects
/// nothing: results must be equal whoever computes them, and must appear whole (AtomicFile).
///
/// Thread safety: an object belongs to one thread; two threads of a process can compete for a lease.
class Lease {
 public:
  /// Takes the lease `path`, whose folder must exist. Waits until it is free or has expired. Returns null if
  /// the folder cannot be written, `patience` has passed, or `cancelled` returns true.
  static std::unique_ptr<Lease> take(const std::filesystem::path& path,
                                     const std::function<bool()>& cancelled,
                                     std::chrono::milliseconds patience, const LeaseTiming& timing = {});
  /// Ends the lease.
  ~Lease();
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

 private:
  Lease(std::filesystem::path path, int descriptor, std::string owner, const LeaseTiming& timing);
  void renew();
  bool write_count();

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string owner_;
  LeaseTiming timing_;
  uint64_t count_ = 0;
  std::mutex mutex_;  // guards ending_
  std::condition_variable wake_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace pelage
