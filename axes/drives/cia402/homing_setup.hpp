#pragma once
// Method, speeds and acceleration of one homing run, written by SDO and read back before the run starts. The cycle asks and holds the
// start back, the service side writes: two threads, a few atomics, nothing waits. Sources: CiA 402-2 (6098h, 6099h, 609Ah).

#include <array>
#include <atomic>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class HomingSetup {
public:
    static constexpr std::size_t count = 4;
    struct Object {
        std::uint16_t index = 0;
        std::uint8_t sub = 0;
        std::uint8_t bytes = 4;
        bool readable = true;  ///< else it cannot be verified (SE-808X 6098h)
    };
    using Values = std::array<std::int64_t, count>;

    /// Before the cycle. `at_start`: what the start-up list leaves in the drive; a method of 0: unknown.
    void configure(const std::array<Object, count>& objects, const Values& at_start) noexcept {
        objects_ = objects;
        at_start_ = have_ = at_start;
    }

    // --- in the cycle; real-time safe -----------------------------------------------------------------------------------
    /// The drive has these settings. Asks for them if not; answer in a later cycle.
    [[nodiscard]] bool ready(const DriveHomingSetup& wanted) noexcept;
    /// It did not take what was asked last.
    [[nodiscard]] bool refused() const noexcept { return refused_; }
    /// No run is asked for any more.
    void release() noexcept { refused_ = false; }
    /// The drive was brought up anew: its start-up list holds.
    void forget() noexcept { have_ = at_start_; }

    // --- service side -----------------------------------------------------------------------------------------------------
    void step(ecat::Master& bus, std::size_t slave);

private:
    void finish(bool well) noexcept;

    std::array<Object, count> objects_{};
    Values at_start_{}, have_{}, asked_{};
    std::uint32_t request_ = 0;
    bool refused_ = false;

    std::array<std::atomic<std::int64_t>, count> wanted_{};
    std::atomic<std::uint32_t> wanted_request_{0};
    std::atomic<std::uint64_t> answer_{0};  // request << 1 | taken

    Values writing_{};
    std::uint32_t served_ = 0;
    std::size_t place_ = count;
    bool reading_back_ = false;
    ecat::SdoTicket ticket_ = 0;
};

}  // namespace taktwerk::axes::cia402
