// Numbers of alarms as a person reads them.

#include <gmock/gmock.h>

#include "ecat/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::HasSubstr;

TEST(AlarmWords, TimesStandInTheUnitThatTheirSizeAsksFor) {
    TestMachine m{machine_config(1)};
    const auto said = [&](AlarmId alarm, double nanoseconds) {
        return m.machine->describe({alarm, AlarmSource::slave, 0, nanoseconds, 0}).english;
    };
    EXPECT_THAT(said(ecat::alarm::dc_out_of_sync, 4'884'786), HasSubstr("differ by 4.88 ms"));
    EXPECT_THAT(said(ecat::alarm::dc_out_of_sync, 3'214), HasSubstr("differ by 3.21 us"));
    EXPECT_THAT(said(ecat::alarm::dc_out_of_sync, 812), HasSubstr("differ by 812 ns"));
    EXPECT_THAT(said(ecat::alarm::dc_out_of_sync, 2.5e9), HasSubstr("differ by 2.5 s"));
    EXPECT_THAT(said(ecat::alarm::dc_not_locked, -31'000), HasSubstr("(-31 us off)"));
}

}  // namespace
}  // namespace taktwerk::runtime::testing
