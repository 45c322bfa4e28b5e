// The old text or the new one, with its mode and owner, and nothing beside it.

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "core/replaced_file.hpp"

namespace taktwerk {
namespace {

namespace fs = std::filesystem;

struct ReplacedFile : ::testing::Test {
    fs::path folder = [] {
        std::string name = (fs::temp_directory_path() / "taktwerk-replaced-XXXXXX").string();
        EXPECT_NE(::mkdtemp(name.data()), nullptr);
        return fs::path(name);
    }();
    fs::path file = folder / "kept";
    ~ReplacedFile() override {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
    }
    static std::string text(const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static mode_t mode(const fs::path& path) {
        struct stat info {};
        EXPECT_EQ(::stat(path.c_str(), &info), 0);
        return info.st_mode & 07777;
    }
    std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator{})); }
};

TEST_F(ReplacedFile, ANewOneHasTheModeThatWasAskedForLessTheUmask) {
    const auto umask_before = ::umask(027);
    EXPECT_EQ(replace_file(file, "one", 0666), 0);
    ::umask(umask_before);
    EXPECT_EQ(text(file), "one");
    EXPECT_EQ(mode(file), 0640u);
    EXPECT_EQ(files(), 1u);
}

TEST_F(ReplacedFile, AnOldOneKeepsItsModeAndOwner) {
    ASSERT_EQ(replace_file(file, "one"), 0);
    ASSERT_EQ(::chmod(file.c_str(), 0604), 0);
    const bool root = ::geteuid() == 0;
    if (root) {
        ASSERT_EQ(::chown(file.c_str(), 1234, 2345), 0);
    }
    EXPECT_EQ(replace_file(file, "two"), 0);
    EXPECT_EQ(text(file), "two");
    EXPECT_EQ(mode(file), 0604u);
    struct stat info {};
    ASSERT_EQ(::stat(file.c_str(), &info), 0);
    if (root) {
        EXPECT_EQ(info.st_uid, 1234u);
        EXPECT_EQ(info.st_gid, 2345u);
    }
}

TEST_F(ReplacedFile, WhatAKilledOneLeftBesideItIsNoObstacleAndALinkThereIsNotFollowed) {
    const auto elsewhere = folder / "elsewhere";
    std::ofstream(elsewhere) << "theirs";
    fs::create_symlink(elsewhere, folder / "kept.new");
    EXPECT_EQ(replace_file(file, "mine"), 0);
    EXPECT_EQ(text(file), "mine");
    EXPECT_EQ(text(elsewhere), "theirs");
    EXPECT_EQ(files(), 2u);
}

TEST_F(ReplacedFile, WhereItCannotBeThereIsAReasonAndTheOldText) {
    EXPECT_EQ(replace_file(folder / "nowhere" / "kept", "x"), ENOENT);
    fs::create_directory(file);
    std::ofstream(file / "inside") << "x";
    const int failed = replace_file(file, "x");
    EXPECT_TRUE(failed == EISDIR || failed == ENOTEMPTY) << failed;
    EXPECT_EQ(files(), 1u) << "nothing is left beside it";
}

}  // namespace
}  // namespace taktwerk
