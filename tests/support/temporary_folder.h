// A folder of a test's own, gone when the test ends.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace tessera::testing {

class TemporaryFolderTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        mFolder = std::filesystem::path(::testing::TempDir()) /
                  ("tessera-" + std::string(test->name()) + "-" + std::to_string(::getpid()));
        std::filesystem::create_directories(mFolder);
    }
    void TearDown() override { std::filesystem::remove_all(mFolder); }

    std::string at(const std::string& name) const { return (mFolder / name).string(); }
    std::string contentOf(const std::string& name) const {
        std::ifstream file(at(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path mFolder;
};

}  // namespace tessera::testing
