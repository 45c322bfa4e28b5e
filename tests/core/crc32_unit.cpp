#include "core/crc32.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string_view>

namespace taktwerk {
namespace {

TEST(Crc32, OfTheCheckTextIsTheCataloguedValue) {
    constexpr std::string_view check = "123456789";  // catalogue of parametrised CRC algorithms: CRC-32/ISO-HDLC, check CBF43926h
    const auto all = std::as_bytes(std::span{check.data(), check.size()});
    EXPECT_EQ(crc32(all), 0xCBF43926u);
    EXPECT_EQ(crc32(all.subspan(4), crc32(all.first(4))), 0xCBF43926u);
    EXPECT_EQ(crc32({}), 0u);
}

}  // namespace
}  // namespace taktwerk
