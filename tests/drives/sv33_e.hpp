#pragma once
// The SV33-E of config/drives/sv33-e.yaml on its desk, in PREOP, with a cycle of 1 ms; and what each of its motions begins with.

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test {

inline axes::sim::PlantConfig sv33_e_motor() {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = 131072;  // 17 bit, 1.1.2
    return plant;
}

class Sv33E : public ::testing::Test {
protected:
    explicit Sv33E(const axes::sim::PlantConfig& plant = sv33_e_motor()) : desk("sv33-e", plant) {}

    void map_and_start(std::int64_t mode) {
        ASSERT_EQ(desk.sdo(0x6085, 0, 13'107'200), 0u);
        desk.go_operational();
        desk.pdo(0x6060, mode);
        desk.run(2ms);
        align();
    }
    void align() { desk.pdo(0x607A, desk.position()); }
    void enable() {
        desk.control(6);
        desk.control(7);
        align();
        desk.control(15);
        ASSERT_EQ(desk.power_state(), 0x27u);
        desk.run(300ms);  // P05.13, 250 ms
    }

    DriveDesk desk;
};

}  // namespace taktwerk::test
