// Encodings in which vendors' files come, byte by byte.

#include "ecat/esi/text_encoding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/ecat/esi/esi_text.hpp"

namespace taktwerk::ecat::esi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Result<DecodedText> decoded(std::string_view text) { return decode_text(bytes_of(text), "box.xml"); }

/// Each byte of ASCII as a character of 16 bits, least byte first.
std::string utf16(std::string_view text) {
    std::string out;
    for (const char c : text) out += {c, '\0'};
    return out;
}

TEST(EsiEncoding, Utf8StaysWithoutItsMark) {
    const auto text = decoded("\xEF\xBB\xBF<a>\xC2\xB5s</a>");
    ASSERT_TRUE(text);
    EXPECT_EQ(text->utf8, "<a>\xC2\xB5s</a>");
    EXPECT_THAT(text->remarks, IsEmpty());
}

TEST(EsiEncoding, Latin1AsDeclared) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"iso-8859-1\"?><a>10\xB5s</a>");
    ASSERT_TRUE(text);
    EXPECT_THAT(text->utf8, HasSubstr("10\xC2\xB5s"));
    EXPECT_EQ(text->encoding, "ISO-8859-1");
}

TEST(EsiEncoding, Utf16WithAndWithoutMark) {
    for (const auto& bytes : {"\xFF\xFE" + utf16("<a>b</a>"), utf16("<a>b</a>")}) {
        const auto text = decoded(bytes);
        ASSERT_TRUE(text);
        EXPECT_EQ(text->utf8, "<a>b</a>");
    }
}

TEST(EsiEncoding, ChineseAsDeclared) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"gb2312\"?><a>\xCB\xC5\xB7\xFE</a>");  // servo
    ASSERT_TRUE(text) << text.error().text();
    EXPECT_THAT(text->utf8, HasSubstr("\xE4\xBC\xBA\xE6\x9C\x8D"));
}

TEST(EsiEncoding, StrayBytesInUtf8AreReadAsLatin1AndSaid) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<a>10\xB5s\n20\xB5s</a>");
    ASSERT_TRUE(text);
    EXPECT_THAT(text->utf8, HasSubstr("10\xC2\xB5s\n20\xC2\xB5s"));
    EXPECT_THAT(text->remarks, ElementsAre("2 bytes are not UTF-8, the first in line 2: read as ISO-8859-1"));
}

TEST(EsiEncoding, Utf16ThatIsNoneIsReadAsItIs) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"utf-16\"?><a>b</a>");
    ASSERT_TRUE(text) << text.error().text();
    EXPECT_THAT(text->utf8, HasSubstr("<a>b</a>"));
}

// Four of the ESI files that are public spell it so.
TEST(EsiEncoding, AnEncodingMayBeSpeltAsPeopleSpellIt) {
    for (const char* name : {"ISO8859-1", "iso_8859-1", "ISO-8859-1", "latin1", "Latin-1"}) {
        const auto text = decoded("<?xml version=\"1.0\" encoding=\"" + std::string{name} + "\"?><a>10\xB5s</a>");
        ASSERT_TRUE(text) << name << ": " << text.error().what;
        EXPECT_EQ(text->encoding, "ISO-8859-1");
        EXPECT_THAT(text->utf8, ::testing::HasSubstr("10\xC2\xB5s"));
    }
    for (const char* name : {"UTF8", "utf_8", "Shift_JIS", "windows1252"})
        EXPECT_TRUE(decoded("<?xml version=\"1.0\" encoding=\"" + std::string{name} + "\"?><a>b</a>")) << name;
}

TEST(EsiEncoding, AnUnknownOneIsRefused) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"KOI9\"?><a/>");
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().text(), "box.xml: it is written in 'KOI9', an encoding that is not known here. save the file as UTF-8");
}

TEST(EsiEncoding, BytesThatAreNotOfItAreRefusedWithTheirPlace) {
    const auto text = decoded("<?xml version=\"1.0\" encoding=\"gbk\"?><a>\x81\x20</a>");  // 81h wants a second byte from 40h on
    ASSERT_FALSE(text);
    EXPECT_EQ(text.error().code, "esi.encoding");
    EXPECT_THAT(text.error().what, HasSubstr("byte 39 is not GBK"));
}

}  // namespace
}  // namespace taktwerk::ecat::esi
