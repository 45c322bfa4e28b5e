// Which registers a request means: none in between may be missing, no number may be cut.
#include "modbus/server/register_map.hpp"

#include <gmock/gmock.h>

namespace taktwerk::modbus::server {
namespace {

using ::testing::ElementsAre;

ServedRegister at(Table table, std::uint16_t address, NumberType type = NumberType::uint16, std::uint8_t bit = 0) {
    ServedRegister r;
    r.table = table, r.address = address, r.type = type, r.bit = bit;
    return r;
}

/// Holding: 10 (uint16), 11 and 12 (float32), 13 (bits 1 and 0), then nothing, 20. Input: 10. The last of all: 65534 and 65535.
RegisterMap map_with_a_hole() {
    return RegisterMap{{at(Table::holding, 20), at(Table::holding, 11, NumberType::float32), at(Table::holding, 10),
                        at(Table::holding, 13, NumberType::boolean, 1), at(Table::holding, 13, NumberType::boolean, 0),
                        at(Table::input, 10), at(Table::holding, 65534, NumberType::uint32)}};
}

std::vector<std::size_t> found(const RegisterMap& map, Table table, std::uint16_t address, std::uint16_t count) {
    std::vector<std::size_t> out;
    const auto places = map.find(table, address, count);
    if (!places) return {999};
    for (const auto& place : *places) out.push_back(place.index);
    return out;
}

TEST(RegisterMap, WhatLiesInTheAddressesIsFoundInTheirOrder) {
    const auto map = map_with_a_hole();
    EXPECT_THAT(found(map, Table::holding, 10, 1), ElementsAre(2));
    EXPECT_THAT(found(map, Table::holding, 10, 3), ElementsAre(2, 1));
    EXPECT_THAT(found(map, Table::holding, 10, 4), ElementsAre(2, 1, 3, 4)) << "two bits share a register";
    EXPECT_THAT(found(map, Table::input, 10, 1), ElementsAre(5));
    EXPECT_THAT(found(map, Table::holding, 65534, 2), ElementsAre(6)) << "the last of all";
}

TEST(RegisterMap, AnAddressThatNobodyOffersRefusesAll) {
    const auto map = map_with_a_hole();
    EXPECT_FALSE(map.find(Table::holding, 9, 1));
    EXPECT_FALSE(map.find(Table::holding, 9, 2)) << "before";
    EXPECT_FALSE(map.find(Table::holding, 10, 5)) << "behind";
    EXPECT_FALSE(map.find(Table::holding, 13, 8)) << "in between";
    EXPECT_FALSE(map.find(Table::coil, 10, 1)) << "another table";
    EXPECT_FALSE(RegisterMap{{}}.find(Table::coil, 0, 1));
}

TEST(RegisterMap, ANumberIsNotCut) {
    const auto map = map_with_a_hole();
    EXPECT_FALSE(map.find(Table::holding, 10, 2)) << "its second half is missing";
    EXPECT_FALSE(map.find(Table::holding, 12, 2)) << "its first half is missing";
    EXPECT_TRUE(map.find(Table::holding, 11, 2));
}

TEST(RegisterMap, OnlyBitsOfDifferentPlacesShareARegister) {
    EXPECT_TRUE(overlap(at(Table::holding, 4, NumberType::float32), at(Table::holding, 5)));
    EXPECT_TRUE(overlap(at(Table::holding, 5), at(Table::holding, 4, NumberType::float32)));
    EXPECT_FALSE(overlap(at(Table::holding, 4, NumberType::float32), at(Table::holding, 6)));
    EXPECT_FALSE(overlap(at(Table::holding, 4), at(Table::input, 4)));
    EXPECT_FALSE(overlap(at(Table::holding, 4, NumberType::boolean, 1), at(Table::holding, 4, NumberType::boolean, 2)));
    EXPECT_TRUE(overlap(at(Table::holding, 4, NumberType::boolean, 1), at(Table::holding, 4, NumberType::boolean, 1)));
    EXPECT_TRUE(overlap(at(Table::holding, 4, NumberType::boolean, 1), at(Table::holding, 4)));
    EXPECT_TRUE(overlap(at(Table::coil, 4, NumberType::boolean, 1), at(Table::coil, 4, NumberType::boolean, 2))) << "a coil has one bit";
}

}  // namespace
}  // namespace taktwerk::modbus::server
