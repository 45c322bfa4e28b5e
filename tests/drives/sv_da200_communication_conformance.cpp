// SV-DA200 guide 2.1 note 7, 5.2: process data or SYNC0 that do not come (CT-18).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_communication {
namespace {

constexpr std::int64_t er24_c = 0x180C, er24_a = 0x180A;  // 5.1: main code, sub-code

TEST_F(SvDa200, LostProcessDataAreAFaultOnlyWhileEnabled) {
    ASSERT_EQ(sdo(0x2409, 0, 20), 0u);
    restart();
    arrives.outputs = false;
    run(100);
    EXPECT_FALSE(faulted()) << "watched after enabling only";
    arrives.outputs = true;
    enable_in(csp);
    arrives.outputs = false;
    run(15);
    EXPECT_FALSE(faulted());
    run(50);
    EXPECT_TRUE(faulted());
    EXPECT_EQ(read(0x603F), 0x8100);
    EXPECT_EQ(read(0x4000), er24_c);
}

TEST_F(SvDa200, WithoutSync0TheClockIsMissed) {  // Er24-a
    enable_in(csp);
    arrives.sync0 = false;  // frames come, SYNC0 does not
    run(50);
    EXPECT_TRUE(faulted());
    EXPECT_EQ(read(0x603F), 0x8100);
    EXPECT_EQ(read(0x4000), er24_a);
}

TEST_F(SvDa200, GoesOnByTheLastIncrementForAsManyCyclesAsP427Says) {  // 2.1 note 7
    const auto coasting = [&](std::int64_t cycles) {
        EXPECT_EQ(sdo(0x241B, 0, cycles), 0u);
        run(2);
        auto target = read(0x607A);
        for (int i = 0; i < 50; ++i) {
            pdo(0x607A, target += 20);
            run(1);
        }
        arrives.outputs = false;
        run(8);  // P4.09 is 10 ms
        arrives.outputs = true;
        const auto demanded = read(0x60F4) + position();  // following error and actual
        pdo(0x607A, target);
        run(1);
        run(200);
        return demanded - target;
    };
    enable_in(csp);
    EXPECT_NEAR(static_cast<double>(coasting(0)), 0, 1);
    EXPECT_NEAR(static_cast<double>(coasting(3)), 60, 1) << "three cycles of 20 counts";
    EXPECT_NEAR(static_cast<double>(coasting(5)), 100, 1);
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_communication
