// Recordings as files: what was written is read to the last bit, and what was changed or cut off is told.
#include "runtime/scope_file/scope_file.hpp"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/property_cases.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class ScopeFile : public ::testing::Test {
protected:
    ScopeFile() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-scope-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~ScopeFile() override { fs::remove_all(folder); }

    static ScopeHead head(std::size_t words) {
        ScopeHead h;
        h.machine = "démo \"1\"\n";
        h.cycle = 250us;
        h.words = words;
        h.signals = {{"time_s",
                      "s",
                      SignalKind::real,
                      SignalGroup::machine,
                      "",
                      "machine time",
                      "机器时间",
                      {0, 0, 64, SignalCell::Coding::integer, 1e9},
                      true},
                     {"x.state",
                      "",
                      SignalKind::state,
                      SignalGroup::axis,
                      "x",
                      "state",
                      "轴状态",
                      {1, 8, 8, SignalCell::Coding::natural, 1},
                      true,
                      {{0, "Disabled"}, {7, "ErrorStop"}}}};
        h.first_cycle = 4711;
        h.utime = 1'800'000'000'000'001;
        h.alarms = {{0x3001, "following_error", "axis x", "lags", "跟随误差", 4800}};
        return h;
    }
    std::string write(const ScopeHead& h, const std::vector<std::uint64_t>& columns, std::size_t block) {
        const auto path = (folder / "a.twscope").string();
        auto file = ScopeFileWriter::create(path, h);
        EXPECT_TRUE(file.ok());
        const auto rows = columns.size() / h.words;
        for (std::size_t at = 0; at < rows; at += block) {
            const auto count = std::min(block, rows - at);
            std::vector<std::uint64_t> part;
            for (std::size_t w = 0; w < h.words; ++w)
                part.insert(part.end(), columns.begin() + static_cast<std::ptrdiff_t>(w * rows + at),
                            columns.begin() + static_cast<std::ptrdiff_t>(w * rows + at + count));
            EXPECT_TRUE(file->write(part).ok());
        }
        EXPECT_TRUE(file->finish().ok());
        EXPECT_EQ(file->bytes(), fs::file_size(path));
        return path;
    }
    static std::vector<std::byte> bytes_of(const std::string& path) {
        std::ifstream in(path, std::ios::binary);
        std::vector<std::byte> out;
        for (std::istreambuf_iterator<char> c(in), end; c != end; ++c) out.push_back(static_cast<std::byte>(*c));
        return out;
    }
    fs::path folder;
};

TEST_F(ScopeFile, RandomRowsComeBackToTheLastBit) {
    std::mt19937_64 random{5};
    const auto draw = [&](std::size_t low, std::size_t high) { return std::uniform_int_distribution<std::size_t>{low, high}(random); };
    for (std::size_t round = 0; round < property_cases(40); ++round) {
        const auto words = draw(2, 40), rows = draw(1, 700), block = draw(1, 300);
        std::vector<std::uint64_t> columns(words * rows);
        for (auto& value : columns)
            value = draw(0, 3) == 0 ? random() : std::bit_cast<std::uint64_t>(std::sin(static_cast<double>(draw(0, 9))));
        const auto wanted = head(words);

        const auto read = read_scope_file(write(wanted, columns, block));

        ASSERT_TRUE(read.ok()) << read.error().text();
        EXPECT_EQ(read->head(), wanted);
        ASSERT_EQ(read->depth(), rows);
        EXPECT_EQ(read->span().first, 4711u);
        EXPECT_EQ(read->span().last, 4710 + rows);
        std::vector<std::uint16_t> all(words);
        for (std::size_t w = 0; w < words; ++w) all[w] = static_cast<std::uint16_t>(w);
        std::vector<std::uint64_t> out(columns.size());
        EXPECT_EQ(read->read(4711, 4711 + rows, all, out), 4711u);
        ASSERT_EQ(out, columns);
    }
}

TEST_F(ScopeFile, TheHeadIsReadWithoutTheRows) {
    const auto path = write(head(2), std::vector<std::uint64_t>(2 * 500, 7), 256);
    const auto info = look_at_scope_file(path);
    ASSERT_TRUE(info.ok()) << info.error().text();
    EXPECT_EQ(info->rows, 500u);
    EXPECT_EQ(info->head.alarms[0].name, "following_error");
    EXPECT_EQ(info->bytes, fs::file_size(path));
}

TEST_F(ScopeFile, EachCutAndEachChangedByteIsNoticed) {
    std::vector<std::uint64_t> columns;
    for (std::uint64_t i = 0; i < 2 * 64; ++i) columns.push_back(i * i * 12345);
    const auto whole = bytes_of(write(head(2), columns, 32));
    ASSERT_TRUE(parse_scope_file(whole, "a").ok());
    for (std::size_t length = 0; length < whole.size(); ++length)
        ASSERT_FALSE(parse_scope_file(std::span{whole}.first(length), "a").ok()) << "cut off behind " << length;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        auto changed = whole;
        changed[i] ^= std::byte{0x10};
        const auto read = parse_scope_file(changed, "a");
        ASSERT_FALSE(read.ok()) << "byte " << i;
        EXPECT_FALSE(read.error().remedy.empty());
    }
}

TEST_F(ScopeFile, OtherFilesAndNewerVersionsAreToldApart) {
    EXPECT_EQ(parse_scope_file(std::as_bytes(std::span{"time_s,x\n1,2\n"}), "a.csv").error().code, "recording.no_recording");
    auto newer = bytes_of(write(head(2), {1, 2}, 1));
    newer[8] = std::byte{2};
    const auto refused = parse_scope_file(newer, "a");
    EXPECT_EQ(refused.error().code, "recording.version");
    EXPECT_THAT(refused.error().what, HasSubstr("version 2"));
    EXPECT_EQ(read_scope_file((folder / "none.twscope").string()).error().code, "recording.open");
    const auto small = parse_scope_file(bytes_of(write(head(2), std::vector<std::uint64_t>(2000, 1), 256)), "a", 1000);
    EXPECT_EQ(small.error().code, "recording.too_large");
}

TEST(ScopeHeadText, WhatCannotBeUsedIsRefused) {
    const std::string good =
        R"({"machine":"m","cycle_ns":1000000,"words":2,"first_cycle":1,"utime":0,"cut":false,"alarms":[],"signals":[{"name":"a","unit":"","kind":"bit","group":"axis","of":"x","en":"","zh":"","word":1,"first_bit":3,"bits":1,"coding":"natural","per":1,"in_trace":true,"states":[]}]})";
    ASSERT_TRUE(parse_head(good, "a").ok());
    const auto with = [&](const std::string& from, const std::string& to) {
        auto text = good;
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    for (const auto& [from, to] :
         std::vector<std::pair<std::string, std::string>>{{R"("word":1)", R"("word":2)"},
                                                          {R"("bits":1)", R"("bits":65)"},
                                                          {R"("bits":1)", R"("bits":0)"},
                                                          {R"("first_bit":3)", R"("first_bit":64)"},
                                                          {R"("per":1)", R"("per":0)"},
                                                          {R"("kind":"bit")", R"("kind":"beat")"},
                                                          {R"("cycle_ns":1000000)", R"("cycle_ns":0)"},
                                                          {R"("words":2)", R"("words":0)"},
                                                          {R"("words":2)", R"("words":-2)"},
                                                          {R"("first_cycle":1)", R"("first_cycle":18446744073709551615)"},
                                                          {R"("states":[])", R"("states":[[1,2]])"},
                                                          {R"("alarms":[])", R"("alarms":[[[[[[[[]]]]]]]])"},
                                                          {R"("cut":false)", R"("cut":0)"}}) {
        const auto refused = parse_head(with(from, to), "a");
        EXPECT_FALSE(refused.ok()) << to;
    }
    EXPECT_FALSE(parse_head("", "a").ok());
    EXPECT_FALSE(parse_head("[]", "a").ok());
    EXPECT_FALSE(parse_head("\xff", "a").ok());
}

}  // namespace
}  // namespace taktwerk::runtime
