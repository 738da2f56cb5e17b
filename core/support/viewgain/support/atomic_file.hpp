// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string_view>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Mode and group of a file, for the one that replaces it.
class VIEWGAIN_EXPORT Permissions {
 public:
  /// Those of the file that stat() has described.
  explicit Permissions(const struct stat& status) noexcept;
  /// Gives them to an open file, as far as this process may. If it may not give the group, the
  /// group that the file has gets what everybody has: nobody gains a right.
  void give(int file) const noexcept;

 private:
  mode_t mode_;
  gid_t group_;
};

/// A file that appears whole or not at all, over a power cut too. What is written goes to
/// temporary_path(), in the target's folder; commit() syncs it and renames it to the target, and
/// without a commit() the destructor removes it. Writers that want a file name get
/// temporary_path(), others use write(). TemporaryNames says how the temporary is called; what a
/// killed process left there is removed by the next writer of the same target. In a folder of
/// SyncedTogether that object syncs, and no leftovers are looked for.
///
/// What replaces a file has its permissions: only its owner may open it before commit(), which
/// gives it the mode and the group. A new file has the mode that the umask leaves.
///
/// A symbolic link stays, and the file that it leads to is replaced, or made. A target that is no
/// regular file (a pipe, a device) is written in place, without a rename, and so is one that stands
/// for an open file of this process (/dev/stdout, /dev/fd/N): that goes on where others stopped,
/// even if it is a regular file. A pipe is opened once, by the first write().
///
/// Every failure throws Error(io) that names the target. Thread safety: distinct objects may be
/// used from distinct threads. Cost: bytes are written once; commit() waits for the disk.
class VIEWGAIN_EXPORT AtomicFile {
 public:
  /// Creates the empty temporary file, so that a target that cannot be written is known at once.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write; exists. Only for targets that are regular files or are not there yet.
  [[nodiscard]] const std::filesystem::path& temporary_path() const noexcept { return temporary_; }

  /// Appends bytes.
  void write(std::string_view bytes);

  /// Waits until what is written is on the disk, which commit() leaves to SyncedTogether in its
  /// folder.
  void sync();

  /// Makes the file appear. To be called once, when all is written and other writers have closed
  /// it.
  void commit();

 private:
  [[nodiscard]] bool is_in_place() const noexcept { return temporary_ == resolved_; }

  std::filesystem::path target_;         // as given, for messages
  std::filesystem::path resolved_;       // behind symbolic links
  std::filesystem::path temporary_;      // equals resolved_ when written in place
  std::optional<Permissions> replaced_;  // of the file that was there
  bool syncs_ = false;
  int file_ = -1;           // where write() writes, once it is open
  char* listed_ = nullptr;  // the name for remove_temporary_files()
  bool committed_ = false;
};

/// Removes the temporary files of all AtomicFile objects of this process (of the first 64 alive),
/// for a program's handler of a signal that then ends it: safe in a signal's handler. Their writers
/// fail or write into nothing afterwards.
VIEWGAIN_EXPORT void remove_temporary_files() noexcept;

/// Whether the name stands for an open file of this process, as /dev/stdout and /dev/fd/N do, which
/// AtomicFile writes in place. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_open_file(const std::filesystem::path& path) noexcept;

/// Waits until the names in the folder are on the disk, where the file system can say so.
VIEWGAIN_EXPORT void sync_folder(const std::filesystem::path& folder) noexcept;

/// The common case: the whole contents at once. Throws and costs as AtomicFile.
VIEWGAIN_EXPORT void write_file_atomically(const std::filesystem::path& target,
                                           std::string_view contents);

}  // namespace viewgain
