#pragma once
// The SV-DA200 of config/drives/sv-da200.yaml on its desk, with a cycle of 1 ms, as its guide's examples find it: commissioned [2.1], in OP.

#include "tests/drives/drive_desk.hpp"
#include "tests/patience.hpp"

namespace taktwerk::test {

/// 10000 counts a turn [2.1 note 4]; limit switches at -50000 and +50000, home switch from 0 to 5000; the motor stands at -20000.
inline axes::sim::PlantConfig da200_table() {
    axes::sim::PlantConfig plant;
    plant.start = -20000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_from = 0;
    plant.home_to = 5000;
    return plant;
}

class SvDa200 : public ::testing::Test, protected RunningDesk {
protected:
    static constexpr std::int64_t pp = 1, pv = 3, homing = 6, csp = 8, csv = 9, cst = 10;  // 2.3
    static constexpr unsigned reached = 1u << 10, acknowledged = 1u << 12;                 // 3.1.2

    explicit SvDa200(const axes::sim::PlantConfig& plant = da200_table()) : RunningDesk("sv-da200", plant) {
        // Ramps that leave the shape of set-points to the master; the drive has them in CSV too [3.6.2].
        for (const int ramp : {0x6083, 0x6084}) EXPECT_EQ(sdo(static_cast<std::uint16_t>(ramp), 0, 10'000'000), 0u);
    }

    /// "Switch it off and on again" [2.1 note 1].
    void restart() {
        power_cycle();
        go_operational();
        run(2);
    }
    /// 3.3.4: mode, then 6 - 7 - 15 with the target where the motor stands (an increment of 0 with P0.37 = 0).
    void enable_in(std::int64_t mode) {
        pdo(0x6060, mode);
        pdo(0x607A, read(0x2025) == 0 ? 0 : position());
        control(6, 2);
        control(7, 2);
        control(15, 2);
    }
    /// As SDOs do, one after the other.
    void home_by(std::int64_t method) {
        ASSERT_EQ(sdo(0x6098, 0, method), 0u);
        ASSERT_EQ(sdo(0x6099, 1, 20000), 0u);
        ASSERT_EQ(sdo(0x6099, 2, 2000), 0u);
        ASSERT_EQ(sdo(0x609A, 0, 200000), 0u);
    }
    /// Cyclic targets, `step` counts a millisecond, until the motor is at `place` of the table.
    void follow_to(double place, std::int64_t step = 20) {
        const auto target = read(0x607A) + static_cast<std::int64_t>(place - axis().plant().position());
        for (Patience patience; patience.lasts(std::abs(target - read(0x607A)) > step);) {
            pdo(0x607A, read(0x607A) + (target > read(0x607A) ? step : -step));
            run(1);
        }
        run(50);
    }
    [[nodiscard]] unsigned bit_of(std::uint16_t index, unsigned n) { return static_cast<unsigned>(read(index) >> n) & 1u; }
};

}  // namespace taktwerk::test
