// docs/gcode.md says of every word that the reader knows what it does with it.

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fb_library/gcode/code_table.hpp"
#include "fb_library/gcode/fault.hpp"

namespace taktwerk::gcode {
namespace {

struct Page : ::testing::Test {
    Page() {
        std::ifstream file(TAKTWERK_SOURCE_DIR "/docs/gcode.md");
        const std::string all{std::istreambuf_iterator<char>(file), {}};
        const auto refused_at = all.find("## What is refused"), end = all.find("And what would be a guess");
        const auto offered_at = all.find("## What is understood");
        offered = all.substr(offered_at, refused_at - offered_at), refused = all.substr(refused_at, end - refused_at),
        errors = all.substr(all.find("## Errors"));
    }
    static std::string word(char letter, int number, int tenths) {
        return "`" + std::string(1, letter) + std::to_string(number) + (tenths == 0 ? "" : "." + std::to_string(tenths)) + "`";
    }
    void expect(const CodeEntry& entry, const std::string& word) const {
        const auto& here = entry.refused.empty() ? offered : refused;
        const auto& elsewhere = entry.refused.empty() ? refused : offered;
        EXPECT_NE(here.find(word), std::string::npos) << word;
        EXPECT_EQ(elsewhere.find(word), std::string::npos) << word;
    }
    std::string offered, refused, errors;
};

TEST_F(Page, HasEveryWordWhereItBelongs) {
    std::size_t words = 0;
    for (int tenths = 0; tenths < 1000; ++tenths)
        if (const auto* entry = find_g(tenths)) expect(*entry, word('G', tenths / 10, tenths % 10)), ++words;
    for (int number = 0; number <= 100; ++number)
        if (const auto* entry = find_m(number)) expect(*entry, word('M', number, 0)), ++words;
    EXPECT_GT(words, 100u);
    EXPECT_EQ(find_m(200), nullptr);
    EXPECT_NE(find_m(199), nullptr);
}

TEST_F(Page, HasEveryErrorsCode) {
    for (const auto& row : fault_words()) EXPECT_NE(errors.find("`" + std::string(row.code) + "`"), std::string::npos) << row.code;
}

}  // namespace
}  // namespace taktwerk::gcode
