// An archive that tar(1) opens: it is asked.
#include "apps/diag/tar.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace taktwerk::apps {
namespace {

namespace fs = std::filesystem;

struct Folder {
    Folder() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-tar-XXXXXX").string();
        path = ::mkdtemp(pattern.data());
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    fs::path path;
};

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// Sizes at both sides of a block of 512 bytes, and a path that is longer than the name's 100.
TEST(Tar, TarTakesOutWhatWasPutIn) {
    if (std::system("tar --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "tar is not installed";
    const Folder folder;
    const std::string deep = "cell-20261126T101500.000-diag/" + std::string(60, 'd') + "/" + std::string(80, 'f') + ".txt";
    ASSERT_GT(deep.size(), 100u);
    const std::vector<std::pair<std::string, std::string>> all{
        {"empty", ""}, {"one", "1"}, {"a/511", std::string(511, 'a')}, {"a/512", std::string(512, 'b')}, {"a/513", std::string(513, '\0')},
        {deep, "deep"}};
    std::string archive;
    for (const auto& [path, bytes] : all) archive += tar_member(path, bytes, 1'764'109'646);
    archive += tar_end();
    EXPECT_EQ(archive.size() % 512, 0u);
    std::ofstream(folder.path / "x.tar", std::ios::binary) << archive;

    ASSERT_EQ(std::system(("cd '" + folder.path.string() + "' && tar xf x.tar 2> said").c_str()), 0) << read(folder.path / "said");

    EXPECT_EQ(read(folder.path / "said"), "");
    for (const auto& [path, bytes] : all) EXPECT_EQ(read(folder.path / path), bytes) << path;
}

// IEEE Std 1003.1, ustar: the sum of the header's bytes with blanks for itself, six octal digits, NUL, blank; sizes in octal.
TEST(Tar, FieldsOfTheHeader) {
    const auto member = tar_member("a", "xyz", 0);
    ASSERT_EQ(member.size(), 1024u);
    EXPECT_EQ(member.substr(124, 11), "00000000003");
    EXPECT_EQ(member.substr(257, 8), std::string("ustar\0"
                                                 "00",
                                                 8));
    unsigned sum = 0;
    for (std::size_t i = 0; i < 512; ++i) sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(member[i]);
    char expected[9];
    std::snprintf(expected, sizeof expected, "%06o", sum);
    EXPECT_EQ(member.substr(148, 6), expected);
}

}  // namespace
}  // namespace taktwerk::apps
