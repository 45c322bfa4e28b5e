#pragma once
// What a drive's error code means: the row of the profile's table, and the further object that tells codes apart which several
// alarms share (SV33-E P21.08). The cycle asks, the service side reads by SDO: two threads, two atomics, nothing waits.

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "axes/port/drive_profile.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class AlarmReader {
public:
    /// `detail_index` as the axis has it (offset applied). Profile and bus outlive the reader.
    AlarmReader(const DriveProfile& profile, std::uint16_t detail_index) noexcept : profile_(profile), detail_index_(detail_index) {}

    // --- in the cycle; real-time safe ---------------------------------------------------------------------------------
    /// `present`: fault, unknown state or a warning with a code.
    void note(bool present, std::uint16_t code, bool warning) noexcept;
    [[nodiscard]] const DriveAlarm& alarm() const noexcept { return alarm_; }

    // --- service side ---------------------------------------------------------------------------------------------------
    void step(ecat::Master& bus, std::size_t slave);

private:
    void look_up() noexcept;

    const DriveProfile& profile_;
    std::uint16_t detail_index_;
    DriveAlarm alarm_;
    bool present_ = false;
    std::uint16_t occurrence_ = 0;  // an alarm that goes and returns with the same code may have another detail
    std::uint32_t request_ = 0;     // occurrence << 16 | code; 0: nothing to read

    std::atomic<std::uint32_t> wanted_{0};
    std::atomic<std::uint64_t> answer_{0};  // request << 32 | detail

    std::uint32_t asked_ = 0;
    ecat::SdoTicket ticket_ = 0;
};

}  // namespace taktwerk::axes::cia402
