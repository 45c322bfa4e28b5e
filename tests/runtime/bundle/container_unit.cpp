// The container: what is written is read, and nothing else is.

#include "runtime/bundle/container.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::runtime {
namespace {

using ::testing::HasSubstr;

Result<Container> read(const std::string& text) { return read_container(BundleText(text), "a.twb"); }

std::string code_of(const std::string& text) {
    const auto container = read(text);
    return container ? "taken" : container.error().code;
}

/// A header by hand, as POSIX.1-1988 has it, with a right check sum whatever it says.
struct RawHeader {
    std::string name = "a", link{}, prefix{};
    char kind = '0';
    std::string size = "00000000003";
    [[nodiscard]] std::string text() const {
        std::string out(512, '\0');
        const auto put = [&](std::size_t at, const std::string& value) { out.replace(at, value.size(), value); };
        put(0, name), put(100, "0000644"), put(108, "0000000"), put(116, "0000000"), put(124, size), put(136, "00000000007");
        put(148, "        ");
        out[156] = kind;
        put(157, link),
            put(257, std::string("ustar\0"
                                 "00",
                                 8)),
            put(345, prefix);
        unsigned sum = 0;
        for (const char c : out) sum += static_cast<unsigned char>(c);
        put(148, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
        return out;
    }
};

const std::string three = "abc" + std::string(509, '\0');
const std::string the_end(1024, '\0');

TEST(Container, HoldsWhatWasPutIn) {
    ContainerText text(small_time);
    ASSERT_TRUE(text.add("manifest.json", "{}"));
    ASSERT_TRUE(text.add("files/empty", ""));
    ASSERT_TRUE(text.add("files/block", std::string(512, 'x')));
    const std::string deep = "files/" + std::string(60, 'd') + "/" + std::string(90, 'e');
    ASSERT_TRUE(text.add(deep, "long")) << "a path that needs the prefix";
    const auto whole = text.finish();
    EXPECT_EQ(whole.size() % 512, 0u);
    const auto container = read(whole);
    ASSERT_TRUE(container) << container.error().text();
    ASSERT_EQ(container->files.size(), 4u);
    EXPECT_EQ(container->files[0].path, "manifest.json");
    EXPECT_EQ(whole.substr(container->files[0].offset, container->files[0].size), "{}");
    EXPECT_EQ(container->files[1].size, 0u);
    EXPECT_EQ(container->files[3].path, deep);
    EXPECT_EQ(whole.substr(container->files[3].offset, 4), "long");
    EXPECT_EQ(container->stamp, small_time);
}

// The positive control of what follows: the header by hand is one that is taken.
TEST(Container, AHeaderByHandIsTaken) {
    const auto container = read(RawHeader{}.text() + three + the_end);
    ASSERT_TRUE(container) << container.error().text();
    EXPECT_EQ(container->files[0].path, "a");
    EXPECT_EQ(container->files[0].size, 3u);
    EXPECT_EQ(container->stamp, 7);
}

TEST(Container, PathsThatLeadOutOfItAreRefused) {
    for (const std::string name : {"../a", "/etc/passwd", "a/../b", "a/..", "..", ".", "./a", "a//b", "a/", "a\\b", "a\nb", "a\x7f"}) {
        const auto container = read(RawHeader{.name = name}.text() + three + the_end);
        ASSERT_FALSE(container) << name;
        EXPECT_EQ(container.error().code, "bundle.path") << name;
    }
    EXPECT_EQ(code_of(RawHeader{.name = "passwd", .prefix = "/etc"}.text() + three + the_end), "bundle.path");
    EXPECT_EQ(code_of(RawHeader{.name = "b", .prefix = ".."}.text() + three + the_end), "bundle.path");
}

TEST(Container, WhatIsNoFileIsRefusedByName) {
    const std::vector<std::pair<char, const char*>> kinds{{'1', "a hard link"},  {'2', "a symbolic link"}, {'3', "a device"},
                                                          {'4', "a device"},     {'5', "a folder"},        {'6', "a pipe"},
                                                          {'7', "an extension"}, {'x', "an extension"},    {'g', "an extension"},
                                                          {'L', "an extension"}, {'S', "an extension"},    {'\0', "an extension"}};
    for (const auto& [kind, words] : kinds) {
        const auto container = read(RawHeader{.link = "/etc/shadow", .kind = kind}.text() + three + the_end);
        ASSERT_FALSE(container) << kind;
        EXPECT_EQ(container.error().code, "bundle.path") << kind;
        EXPECT_THAT(container.error().what, HasSubstr(words));
    }
    EXPECT_EQ(code_of(RawHeader{.link = "b"}.text() + three + the_end), "bundle.damaged") << "a file has no link";
}

TEST(Container, NoNameComesTwice) {
    const auto one = RawHeader{}.text() + three;
    EXPECT_EQ(code_of(one + one + the_end), "bundle.twice");
    EXPECT_EQ(code_of(one + RawHeader{.name = "b"}.text() + three + the_end), "taken");
}

TEST(Container, SizesThatNothingHasAreRefusedBeforeAnythingIsRead) {
    EXPECT_EQ(code_of(RawHeader{.size = "77777777777"}.text() + three + the_end), "bundle.too_large");
    EXPECT_EQ(code_of(RawHeader{.size = "04000000001"}.text() + three + the_end), "bundle.too_large") << "512 MiB and one byte";
    EXPECT_EQ(code_of(RawHeader{.size = "04000000000"}.text() + three + the_end), "bundle.damaged") << "512 MiB that are not there";
    EXPECT_EQ(code_of(RawHeader{.size = "-0000000001"}.text() + three + the_end), "bundle.not_a_bundle");
    EXPECT_EQ(code_of(RawHeader{.size = std::string("\x80\0\0\0\0\0\0\0\0\0\3", 11)}.text() + three + the_end), "bundle.not_a_bundle")
        << "the binary sizes of GNU tar";
    class Huge : public ByteSource {
        [[nodiscard]] std::uint64_t size() const override { return largest_bundle + 512; }
        [[nodiscard]] Result<void> read(std::uint64_t, std::span<std::byte>) const override {
            ADD_FAILURE() << "it was read";
            return {};
        }
    };
    const auto huge = read_container(Huge{}, "huge.twb");
    ASSERT_FALSE(huge);
    EXPECT_EQ(huge.error().code, "bundle.too_large");
}

TEST(Container, MoreFilesThanABundleHasAreRefused) {
    std::string text;
    for (std::size_t i = 0; i <= most_packed_files; ++i) text += RawHeader{.name = fmt::format("f{}", i), .size = "00000000000"}.text();
    EXPECT_EQ(code_of(text + the_end), "bundle.too_large");
    EXPECT_EQ(code_of(text.substr(512) + the_end), "taken");
}

TEST(Container, EveryLengthThatIsNotTheWholeOneIsRefused) {
    const auto whole = RawHeader{}.text() + three + RawHeader{.name = "b"}.text() + three + the_end;
    ASSERT_EQ(code_of(whole), "taken");
    for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_NE(code_of(whole.substr(0, size)), "taken") << size;
    EXPECT_NE(code_of(whole + '\0'), "taken");
    EXPECT_NE(code_of(whole + std::string(512, '\0')), "taken");
}

TEST(Container, NothingStandsBetweenItsFiles) {
    auto text = RawHeader{}.text() + three + the_end;
    text[512 + 3] = 'x';
    EXPECT_EQ(code_of(text), "bundle.damaged");
    text = RawHeader{}.text() + three + the_end;
    text.back() = 'x';
    EXPECT_EQ(code_of(text), "bundle.damaged");
}

TEST(Container, WhatIsNoBundleAtAllIsSaidToBeNone) {
    for (const auto& text : {std::string(), std::string("name: cell\n"), std::string(4096, '\0'), std::string(4096, '\xff')})
        EXPECT_EQ(code_of(text), "bundle.not_a_bundle");
}

TEST(Container, WillNotWriteWhatItWouldNotRead) {
    ContainerText text(small_time);
    EXPECT_FALSE(text.add("../a", ""));
    EXPECT_FALSE(text.add(std::string(101, 'x'), "")) << "no slash to part it at";
    EXPECT_TRUE(is_packed_path(std::string(100, 'x')));
    EXPECT_FALSE(is_packed_path(std::string(101, 'x')));
}

}  // namespace
}  // namespace taktwerk::runtime
