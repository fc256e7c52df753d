#include "write_file.h"

#include <fstream>

#include "spelunk/common/contract.h"

namespace spelunk::evaluation {

void writeFile(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) throw OutsideError("cannot write '" + path + "': check the folder's rights and space");
}

}  // namespace spelunk::evaluation
