#pragma once

#include <string>

namespace spelunk::evaluation {

/// Keeps a folder of results for this process alone as long as the object lives. Leaves no file
/// behind; where the file system knows no locks, nothing is kept.
class FolderLock {
 public:
  /// Throws OutsideError if another process has it.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace spelunk::evaluation
