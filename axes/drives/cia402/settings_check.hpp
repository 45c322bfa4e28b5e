#pragma once
// What a drive's own parameters must be before it may be enabled, and the units they choose: read by SDO each time the drive comes
// into OP. The cycle asks and waits for the verdict, the service side reads: two threads, atomics, nothing waits.
// Whether a turn of the motor is as many counts for the drive as for the axis belongs to it: otherwise the axis travels another way than it
// shows. Sources: SV-DA200 2.1; SE-808X 6 (step 2); SV33-E 3.1.5; general over DriveProfile::required_settings and DriveProfile::units.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/time.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

/// What an axis relies on in its drive, beyond what the profile says of every machine.
struct AxisWants {
    std::int64_t counts_per_revolution = 0;  ///< 0: not compared
    std::vector<StoredSetting> stored{};
    DriveMode mode = DriveMode::none;  ///< in which it is moved; none: it only measures
};

class SettingsCheck {
public:
    enum class Verdict : std::uint8_t { unknown, fits, refused };

    /// `offset` is added to the objects of a further axis. Profile and bus outlive the check.
    SettingsCheck(const DriveProfile& profile, std::uint16_t offset, Duration cycle, AxisWants wants);

    // --- in the cycle; real-time safe ---------------------------------------------------------------------------------
    /// Whether the drive is in OP; what is known of its parameters ends when it leaves.
    void online(bool now) noexcept;
    /// Level. A reset while they are refused reads them again: they were set at the drive meanwhile, or could not be read.
    void reset(bool asked) noexcept;
    /// `unknown` as long as the drive is away or the reading goes on: it is not enabled meanwhile.
    [[nodiscard]] Verdict verdict() const noexcept;
    /// 606Ch, 60FFh, 607Fh raw = counts/s times this, in the units that the drive is in.
    [[nodiscard]] double velocity_counts_per_unit() const noexcept { return velocity_.load(std::memory_order_relaxed); }

    /// Bits of 6041h that these units do not show, or may not: nobody waits for them.
    [[nodiscard]] std::uint16_t status_hidden() const noexcept { return hidden_.load(std::memory_order_relaxed); }

    // --- service side ---------------------------------------------------------------------------------------------------
    void step(ecat::Master& bus, std::size_t slave);
    /// An object that was read may have changed: it is read again before the drive is enabled next. Where it counts after a restart only and
    /// is part of the scale, nobody knows any more what is in force: refused until the drive has been away.
    void changed(ParameterAddress address) noexcept;
    /// It says how many counts are a turn of the motor.
    [[nodiscard]] bool part_of_scale(ParameterAddress object) const noexcept;
    /// In words, with value, remedy and section of the manual.
    [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }

private:
    struct Reading {
        ParameterAddress object;
        std::int64_t value = 0;
        bool known = false;
        bool silent = false;  ///< nobody answered, which says nothing about the object
    };
    void take(Reading& reading, const Result<ecat::SdoResult>& answer, const ecat::SlaveConfig& slave);
    void want(ParameterAddress object);
    [[nodiscard]] const Reading* reading(ParameterAddress object) const noexcept;
    void judge(const ecat::SlaveConfig& slave);
    void judge_units(const ecat::SlaveConfig& slave);
    void judge_stored(const ecat::SlaveConfig& slave);
    void judge_scale(const ecat::SlaveConfig& slave);
    [[nodiscard]] std::string named(ParameterAddress object) const;
    [[nodiscard]] bool is_signed(const ecat::SlaveConfig& slave, ParameterAddress object) const noexcept;

    const DriveProfile& profile_;
    std::uint16_t offset_;
    Duration cycle_;
    AxisWants wants_;
    std::vector<Reading> readings_;
    std::vector<ParameterAddress> waiting_;  ///< parts of the scale that were written and count after a restart only

    // Written by the cycle (coming into OP) and the service side (changed); each count is one reading of all objects.
    std::atomic<std::uint32_t> wanted_{0};
    std::atomic<std::uint32_t> came_{0};  // times that the drive came into OP
    std::uint32_t seen_coming_ = 0;
    std::atomic<std::uint64_t> judged_{0};  // count << 8 | verdict
    std::atomic<double> velocity_;
    std::atomic<std::uint16_t> hidden_{0};
    bool online_ = false, reset_asked_ = false;

    std::uint32_t under_way_ = 0;  // the count that is being read; 0: none
    std::size_t next_ = 0;
    bool again_ = false;  // the next one is asked for the second time
    ecat::SdoTicket ticket_ = 0;
    std::vector<std::string> problems_;
};

}  // namespace taktwerk::axes::cia402
