// Who is believed about a slave's process data, and how differences are told.
#include "ecat/bringup/effective_pdos.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<PdoDescription> pdos(std::vector<PdoEntry> entries) { return {{0x1A00, true, std::move(entries)}}; }

TEST(EffectivePdos, KeepTheNamesOfTheConfigurationWhereTheEepromLaysOutTheSameBits) {
    const auto both = without_coe(pdos({{0x3101, 1, 1}, {0, 0, 7}}), pdos({{0x6000, 1, 1}, {0, 0, 7}}), "inputs");
    EXPECT_EQ(both.pdos[0].entries[0].index, 0x6000);
    EXPECT_THAT(both.remark, IsEmpty());
}

TEST(EffectivePdos, AreTheEepromsWhereTheLayoutsDiffer) {
    // A gap is no entry: the same 8 bits, laid out otherwise.
    const auto eeprom = without_coe(pdos({{0x3101, 1, 1}, {0, 0, 7}}), pdos({{0x6000, 1, 1}, {0x6000, 2, 7}}), "inputs");
    EXPECT_EQ(eeprom.pdos[0].entries[0].index, 0x3101);
    EXPECT_THAT(eeprom.remark, HasSubstr("inputs are mapped as its EEPROM says (8 bits)"));
}

TEST(EffectivePdos, AreTheConfigurationsWhereTheEepromListsNone) {
    const auto configured = without_coe({}, pdos({{0x6000, 1, 8}}), "inputs");
    EXPECT_EQ(configured.pdos.size(), 1u);
    EXPECT_THAT(configured.remark, HasSubstr("as the configuration says"));
    EXPECT_THAT(without_coe({}, {}, "inputs").remark, IsEmpty());
}

TEST(EffectivePdos, OfAnEepromAreThoseThatItAssigns) {
    SiiPdo used, unused;
    used.index = 0x1A00, used.sync_manager = 3;
    used.entries = {{0x6000, 1, 0, 1, 1, 0}};
    unused.index = 0x1A01;
    const auto assigned = assigned_in_eeprom({used, unused});
    ASSERT_EQ(assigned.size(), 1u);
    EXPECT_EQ(assigned[0].index, 0x1A00);
    EXPECT_EQ(assigned[0].sync_manager, 3);
    EXPECT_EQ(assigned[0].entries, (std::vector<PdoEntry>{{0x6000, 1, 1}}));
}

TEST(SyncManagers, OfAnEepromKeepTheirNumbersPastUnusedOnes) {
    Sii sii;
    sii.sync_managers = {{0x1000, 4, 0x44, 0, 0, SiiSyncManagerUse::unused}, {0x1100, 2, 0x20, 0, 1, SiiSyncManagerUse::inputs}};
    const auto managers = sync_managers_in_eeprom(sii);
    ASSERT_EQ(managers.size(), 2u);
    EXPECT_EQ(managers[0].size, 0);
    EXPECT_EQ(managers[1].use, SmUse::inputs);
    EXPECT_EQ(managers[1].size, 2);
}

}  // namespace
}  // namespace taktwerk::ecat
