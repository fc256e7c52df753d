#include "spelunk/common/file_lookup.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "spelunk/common/contract.h"
#include "support/temporary_folder.h"

namespace spelunk {
namespace {

namespace fs = std::filesystem;

class FileLookup : public ::testing::Test {
 protected:
  FileLookup() {
    fs::create_directories(first_);
    fs::create_directories(second_);
  }

  static std::string write(const fs::path& path) {
    std::ofstream(path) << "x";
    return path.string();
  }

  const test::TemporaryFolder folder_;
  const fs::path first_ = folder_.at("first");
  const fs::path second_ = folder_.at("second");
};

TEST_F(FileLookup, TellsPathsFromNames) {
  EXPECT_TRUE(looksLikePath("meshes/mine"));
  EXPECT_TRUE(looksLikePath("mine.stl"));
  EXPECT_FALSE(looksLikePath("long_wall"));
}

TEST_F(FileLookup, TakesTheFirstFolderThatHasTheFile) {
  const std::string in_second = write(second_ / "mine.stl");
  EXPECT_EQ(existingFile("mesh", "mine.stl", {first_, second_}), in_second);
  const std::string in_first = write(first_ / "mine.stl");
  EXPECT_EQ(existingFile("mesh", "mine.stl", {first_, second_}), in_first);
  EXPECT_EQ(existingFile("mesh", "../second/mine.stl", {first_}), in_second);
}

TEST_F(FileLookup, TakesAnAbsolutePathAsItIs) {
  const std::string file = write(second_ / "mine.stl");
  EXPECT_EQ(existingFile("mesh", file, {first_}), file);
}

TEST_F(FileLookup, KnowsTheHomeFolder) {
  const std::string file = write(second_ / "mine.stl");
  const char* set_before = std::getenv("HOME");
  const std::string before = set_before == nullptr ? "" : set_before;
  setenv("HOME", second_.c_str(), 1);
  EXPECT_EQ(existingFile("mesh", "~/mine.stl", {first_}), file);
  if (set_before != nullptr) setenv("HOME", before.c_str(), 1);
}

TEST_F(FileLookup, NamesEveryPathThatWasTried) {
  try {
    static_cast<void>(existingFile("mesh", "mine.stl", {first_, second_}));
    FAIL();
  } catch (const OutsideError& error) {
    const std::string text = error.what();
    for (const fs::path& folder : {first_, second_})
      EXPECT_NE(text.find((folder / "mine.stl").string()), std::string::npos) << text;
    EXPECT_NE(text.find("mesh 'mine.stl'"), std::string::npos) << text;
  }
}

TEST_F(FileLookup, DoesNotTakeAFolderForAFile) {
  EXPECT_THROW(static_cast<void>(existingFile("mesh", first_.string(), {""})), OutsideError);
}

}  // namespace
}  // namespace spelunk
