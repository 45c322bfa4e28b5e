#pragma once
// A drive on its desk whose first axis runs at a constant speed by cyclic positions, as most do when something fails.

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test {

class MovingDesk : public RunningDesk {
public:
    static constexpr std::int64_t csp = 8;
    static constexpr std::int64_t step = 50;  ///< counts a millisecond: five turns a second of the motor of long_table()

    explicit MovingDesk(const std::string& name, const axes::sim::PlantConfig& plant = long_table(), const MotorFacts& motor = {})
        : RunningDesk(name, plant, 1ms, motor) {}

    /// Enabled in CSP, at standstill, past its brake and what it does not hear.
    void stand() {
        pdo(0x6060, csp);
        run(50);  // TSVM 5.4.1: the change of mode; its self-test
        enable();
        target_ = position();
        run(150);  // TSVM 5.3.1: deaf for 100 ms
        ASSERT_TRUE(enabled()) << std::hex << status();
    }
    /// ... and at `per_ms` counts a millisecond, after a ramp.
    void go(std::int64_t per_ms = step) {
        stand();
        for (std::int64_t speed = 0; speed != per_ms; speed += per_ms > 0 ? 1 : -1) follow(speed, 1);
        follow(per_ms, 100);
    }
    void follow(std::int64_t per_ms, int cycles) {
        for (int i = 0; i < cycles; ++i) {
            pdo(0x607A, target_ += per_ms);
            cycle();
        }
    }
    /// Goes on until the drive shows an alarm, at most so long.
    bool follow_until_alarm(std::int64_t per_ms, Duration patience) {
        for (const auto end = now + patience; now < end && code() == 0;) follow(per_ms, 1);
        return code() != 0;
    }
    void reset(std::uint16_t control_word = 0x6040) {
        for (const int word : {0x00, 0x80, 0x00}) {
            pdo(control_word, word);
            run(4);
        }
    }
    /// 603Fh of an axis, and the object that tells apart alarms that share a code; 0 where there is none.
    [[nodiscard]] std::int64_t code(unsigned axis = 0) {
        return read(static_cast<std::uint16_t>(0x603F + axis * drive.profile->object_offset));
    }
    [[nodiscard]] std::int64_t detail() {
        return drive.profile->alarm_detail_index ? read(drive.profile->alarm_detail_index, drive.profile->alarm_detail_sub) : 0;
    }

private:
    std::int64_t target_ = 0;
};

}  // namespace taktwerk::test
