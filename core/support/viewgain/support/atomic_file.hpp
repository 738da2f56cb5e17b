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

/// Mode and group of a file, for the file that replaces it.
class VIEWGAIN_EXPORT Permissions {
 public:
  /// Takes mode and group from the result of stat().
  explicit Permissions(const struct stat& status) noexcept;
  /// Sets them on an open file, as far as this process may. If it may not set the group, the file's
  /// group gets only the permissions of others, so that nobody gains a permission.
  void give(int file) const noexcept;

 private:
  mode_t mode_;
  gid_t group_;
};

/// A file that appears completely or not at all, even after a power cut. Data go to
/// temporary_path(), in the target's folder. commit() syncs this file and renames it to the target;
/// without commit() the destructor removes it. Use write(), or give temporary_path() to a writer
/// that needs a name. TemporaryNames defines the name. The next writer of the same target removes
/// what a killed process left. In a folder of SyncedTogether that object does the sync, and
/// leftovers stay.
///
/// A replacement is private until commit(), which gives it the mode and group of the replaced file.
/// A new file has the mode from the umask.
///
/// A symbolic link stays, and its target is replaced or created. Pipes, devices and names of open
/// files of this process (/dev/stdout, /dev/fd/N) are written in place, at the current position. A
/// pipe is opened once, by the first write().
///
/// Every failure throws Error(io) that names the target. Thread safety: distinct objects may be
/// used from distinct threads. Cost: bytes are written once; commit() waits for the disk.
class VIEWGAIN_EXPORT AtomicFile {
 public:
  /// Creates the empty temporary file, so that a target that cannot be written fails at once.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The existing file to write to. Only for targets that are regular files or do not exist yet.
  [[nodiscard]] const std::filesystem::path& temporary_path() const noexcept { return temporary_; }

  /// Appends bytes.
  void write(std::string_view bytes);

  /// Waits until the data are on the disk. commit() does this too, except in a folder of
  /// SyncedTogether.
  void sync();

  /// Makes the file appear. Call it once, after everything is written and other writers have closed
  /// the file.
  void commit();

 private:
  [[nodiscard]] bool is_in_place() const noexcept { return temporary_ == resolved_; }

  std::filesystem::path target_;         // as given, for messages
  std::filesystem::path resolved_;       // with symbolic links resolved
  std::filesystem::path temporary_;      // equals resolved_ when written in place
  std::optional<Permissions> replaced_;  // of the replaced file
  bool syncs_ = false;
  int file_ = -1;           // descriptor for write(), once it is open
  char* listed_ = nullptr;  // the name for remove_temporary_files()
  bool committed_ = false;
};

/// Removes the temporary files of all AtomicFile objects of this process (at most 64). For a signal
/// handler that then ends the program; safe in a signal handler. Afterwards their writers fail, or
/// their data are lost.
VIEWGAIN_EXPORT void remove_temporary_files() noexcept;

/// Whether the name refers to an open file of this process, like /dev/stdout and /dev/fd/N, which
/// AtomicFile writes in place. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_open_file(const std::filesystem::path& path) noexcept;

/// Waits until the names in the folder are on the disk, if the file system supports that.
VIEWGAIN_EXPORT void sync_folder(const std::filesystem::path& folder) noexcept;

/// Writes the whole contents at once. Errors and cost: see AtomicFile.
VIEWGAIN_EXPORT void write_file_atomically(const std::filesystem::path& target,
                                           std::string_view contents);

}  // namespace viewgain
