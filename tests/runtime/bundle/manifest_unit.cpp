// What a bundle says of itself.

#include "runtime/bundle/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/bundle/small_bundle.hpp"

namespace taktwerk::runtime {
namespace {

using ::testing::HasSubstr;

Manifest whole() {
    auto manifest = small_manifest();
    manifest.files = {{"machine/cell.yaml", "machine", 11, std::string(64, 'a')},
                      {"machine/feeder.so", "program", 700, std::string(64, '0')}};
    return manifest;
}

/// The same with one place of its text changed.
std::string with(const std::string& from, const std::string& to) {
    auto text = text_of(whole());
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

std::string problem_of(const std::string& text) {
    const auto manifest = manifest_of(text, "a.twb");
    return manifest ? "taken" : manifest.error().code + ": " + manifest.error().what;
}

TEST(Manifest, IsReadAsItIsWritten) {
    const auto text = text_of(whole());
    EXPECT_THAT(text, HasSubstr("\"created\": \"2026-11-26T05:12:00Z\""));
    EXPECT_THAT(text, HasSubstr("\"abi\": \"1122334455667788\""));
    const auto manifest = manifest_of(text, "a.twb");
    ASSERT_TRUE(manifest) << manifest.error().text();
    EXPECT_EQ(text_of(*manifest), text);
    EXPECT_EQ(manifest->created, small_time);
    EXPECT_EQ(manifest->programs.at(0).abi, small_host().abi);
    EXPECT_EQ(manifest->files.at(1).size, 700u);
}

TEST(Manifest, ALaterFormSaysWhatToDo) {
    const auto manifest = manifest_of(with("\"taktwerk_bundle\": 1", "\"taktwerk_bundle\": 2"), "a.twb");
    ASSERT_FALSE(manifest);
    EXPECT_EQ(manifest.error().code, "bundle.newer");
    EXPECT_THAT(manifest.error().remedy, HasSubstr("update Taktwerk"));
}

TEST(Manifest, EachKeyHasItsForm) {
    const std::vector<std::pair<std::string, std::string>> changes{
        {"\"cell\"", "\"../cell\""},
        {"\"cell\"", "\"\""},
        {"\"cell\"", "7"},
        {"\"cell\"", "\"" + std::string(41, 'a') + "\""},
        {"\"version\": \"1.0\"", "\"version\": \"1.0/..\""},
        {"\"version\": \"1.0\"", "\"version\": \"..\""},
        {"2026-11-26T05:12:00Z", "2026-02-30T05:12:00Z"},
        {"2026-11-26T05:12:00Z", "2026-11-26T25:12:00Z"},
        {"2026-11-26T05:12:00Z", "yesterday"},
        {"\"target\": \"linux-test\"", "\"target\": \"\""},
        {"1122334455667788", "112233445566778"},
        {"1122334455667788", "112233445566778G"},
        {"\"machine/feeder.so\"", "\"../feeder.so\""},
        {"\"machine/feeder.so\"", "\"/feeder.so\""},
        {"\"size\": 700", "\"size\": -1"},
        {"\"size\": 700", "\"size\": 18446744073709551615"},
        {"\"size\": 700", "\"size\": 7e2"},
        {"\"kind\": \"program\"", "\"kind\": \"script\""},
        {std::string(64, '0'), std::string(63, '0')},
        {std::string(64, '0'), std::string(64, 'A')},
        {"\"files\": [", "\"files\": [7, "},
        {"\"files\"", "\"other\""},
        {"\"programs\"", "\"other\""},
    };
    for (const auto& [from, to] : changes) EXPECT_THAT(problem_of(with(from, to)), HasSubstr("bundle.manifest: ")) << from << " -> " << to;
}

TEST(Manifest, ItsFilesBelongTogether) {
    auto twice = whole();
    twice.files.push_back(twice.files.front());
    EXPECT_THAT(problem_of(text_of(twice)), HasSubstr("twice"));
    auto headless = whole();
    headless.files.erase(headless.files.begin());
    EXPECT_THAT(problem_of(text_of(headless)), HasSubstr("the machine file 'machine/cell.yaml' is not among its files"));
    auto bodiless = whole();
    bodiless.files.pop_back();
    EXPECT_THAT(problem_of(text_of(bodiless)), HasSubstr("'machine/feeder.so' of program 'feeder' is not among its files"));
    auto inside = whole();
    inside.files.push_back({"machine/cell.yaml/x", "cam", 0, std::string(64, '0')});
    EXPECT_THAT(problem_of(text_of(inside)), HasSubstr("'machine/cell.yaml/x' lies in a file"));
}

// One reader takes the first, another one the last: what was signed would mean two things.
TEST(Manifest, AKeyThatStandsTwiceIsRefusedWhereverItIs) {
    const auto text = text_of(whole());
    ASSERT_TRUE(manifest_of(text, "x").ok()) << "the control";
    for (const char* key : {"\"name\":", "\"target\":", "\"abi\":", "\"sha256\":"}) {
        auto twice = text;
        const auto at = twice.find(key);
        ASSERT_NE(at, std::string::npos) << key;
        twice.insert(at, std::string(key) + " \"0\", ");
        EXPECT_THAT(problem_of(twice), HasSubstr("stands there twice")) << key;
    }
}

TEST(Manifest, WhatIsNoJsonIsRefused) {
    for (const auto& text : {std::string(), std::string("[]"), std::string("null"), text_of(whole()).substr(0, 100),
                             std::string(100'000, '['), std::string("{\"a\":{\"a\":{\"a\":{\"a\":{\"a\":{}}}}}}")})
        EXPECT_THAT(problem_of(text), HasSubstr("bundle.manifest")) << text.substr(0, 40);
}

TEST(Versions, AreOrderedByTheirNumbers) {
    EXPECT_TRUE(version_before("1.9", "1.10"));
    EXPECT_FALSE(version_before("1.10", "1.9"));
    EXPECT_TRUE(version_before("0.1.0", "0.1.1"));
    EXPECT_TRUE(version_before("1", "1.0.1"));
    EXPECT_TRUE(version_before("0.1.0", "99999999999999999999.1")) << "more than fits into 64 bits";
    EXPECT_FALSE(version_before("1.0", "1"));
    EXPECT_FALSE(version_before("1", "1.0"));
}

}  // namespace
}  // namespace taktwerk::runtime
