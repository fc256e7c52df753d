#include "write_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "spelunk/common/contract.h"

namespace spelunk::evaluation {

void writeFile(const std::string& path, const std::string& bytes) {
  const std::string partial = path + "." + std::to_string(getpid()) + ".part";
  std::ofstream file(partial, std::ios::binary);
  file << bytes;
  file.close();
  std::error_code failure;
  if (file) std::filesystem::rename(partial, path, failure);
  if (file && !failure) return;
  std::filesystem::remove(partial, failure);
  throw OutsideError("cannot write '" + path + "': check the folder's rights and space");
}

}  // namespace spelunk::evaluation
