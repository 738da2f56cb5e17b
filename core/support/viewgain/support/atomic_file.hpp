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

/// Mode and group of a file, to give them to the file that replaces it.
class VIEWGAIN_EXPORT Permissions {
 public:
  /// `status`: result of stat() for the file.
  explicit Permissions(const struct stat& status) noexcept;
  /// Sets mode and group of an open file, given by its descriptor, as far as this process is
  /// allowed to. If it may not set the group, the group gets only the permissions that all other
  /// users have, so that nobody gains a permission.
  void give(int file) const noexcept;

 private:
  mode_t mode_;
  gid_t group_;
};

/// Writes a file so that it appears completely or not at all, even after a power cut. Data go to a
/// temporary file in the target's folder; TemporaryNames defines its name. Use write(), or give
/// temporary_path() to a writer that needs a name. commit() syncs the temporary file and renames it
/// to the target. Without commit(), the destructor removes it. The next writer of the same target
/// removes the leftovers of killed processes. In a folder of a SyncedTogether, that object does the
/// sync, and leftovers stay.
///
/// If the target exists, only this user can read the temporary file, until commit() gives it the
/// mode and group of the target. If the target is new, its mode follows from the umask.
///
/// If the target is a symbolic link, the file that it points to is replaced or created. Pipes,
/// devices and names of open files of this process (/dev/stdout, /dev/fd/N) are written directly,
/// at the current position. A pipe is opened once, by the first write().
///
/// All members throw Error(io) that names the target if they fail. Thread safety: different objects
/// may be used from different threads. Cost: bytes are written once; commit() waits for the disk.
class VIEWGAIN_EXPORT AtomicFile {
 public:
  /// Creates the empty temporary file. Fails at once if the target cannot be written.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Path of the temporary file, which exists. Call it only for targets that are regular files or
  /// do not exist yet.
  [[nodiscard]] const std::filesystem::path& temporary_path() const noexcept { return temporary_; }

  /// Appends bytes.
  void write(std::string_view bytes);

  /// Waits until the data are on the disk. commit() does this too, except in a folder of
  /// SyncedTogether.
  void sync();

  /// Makes the file appear under its name. Call it once, when everything is written and other
  /// writers have closed the file.
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

/// Removes the temporary files of all AtomicFile objects of this process (at most 64). Async-signal
/// safe: for a signal handler that then ends the program. Data of these objects are lost, and their
/// members may fail.
VIEWGAIN_EXPORT void remove_temporary_files() noexcept;

/// Whether the name refers to an open file of this process, like /dev/stdout and /dev/fd/N.
/// AtomicFile writes such files directly. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_open_file(const std::filesystem::path& path) noexcept;

/// Waits until the entries of the folder are on the disk, if the file system supports that.
VIEWGAIN_EXPORT void sync_folder(const std::filesystem::path& folder) noexcept;

/// Writes a file with AtomicFile. Errors and cost are those of AtomicFile.
VIEWGAIN_EXPORT void write_file_atomically(const std::filesystem::path& target,
                                           std::string_view contents);

}  // namespace viewgain
