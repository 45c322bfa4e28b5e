// SV-DA200 guide 2.1 note 3: what P4.25 makes of units, inputs and status word, at once (note 1).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test {
namespace {

TEST_F(SvDa200, VelocitiesAreCountsASecondOrRpmAsP425Says) {  // 2.1 note 3; 10000 counts a turn: note 4
    enable_in(csv);
    pdo(0x60FF, 20000);  // 2 turns/s
    run(500);
    EXPECT_NEAR(speed(), 20000, 200);
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 20000, 200);

    pdo(0x60FF, 120);
    ASSERT_EQ(sdo(0x2419, 0, 0), 0u);  // at once: note 1
    run(500);
    EXPECT_NEAR(speed(), 20000, 200) << "120 rpm are 2 turns/s";
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 120, 2);
}

}  // namespace
}  // namespace taktwerk::test
