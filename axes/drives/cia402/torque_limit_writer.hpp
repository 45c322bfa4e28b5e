#pragma once
// Torque limits that are not mapped: written by SDO when they change, never else (some drives store each write). The cycle asks, the service side writes:
// two threads, atomics only, nothing waits. Source: CiA 402-2 (6072h, 60E0h, 60E1h).

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class TorqueLimitWriter {
public:
    static constexpr std::size_t most = 2;        ///< 60E0h and 60E1h, or 6072h alone
    static constexpr std::int64_t no_limit = -1;  ///< as it was at the start
    static constexpr std::int64_t not_stated = -1;
    using Values = std::array<std::int64_t, most>;  ///< raw
    struct Object {
        std::uint16_t index = 0;  ///< 0: none
        std::size_t bytes = 2;
        std::int64_t high = 0xFFFF;  ///< the most it takes
        std::int64_t at_start =
            not_stated;  ///< as the start-up list or the dictionary leaves it; not stated: it is read before the first write
    };
    using Answer = TorqueLimitAnswer;

    /// Before the cycle.
    void use(std::size_t place, const Object& object) noexcept { objects_[place] = object; }
    [[nodiscard]] bool used() const noexcept { return objects_[0].index != 0; }

    // --- in the cycle; real-time safe -----------------------------------------------------------------------------------
    /// Called each cycle. Nothing is written before the first real limit; all of it again when the drive was away, whose start-up list holds then.
    [[nodiscard]] Answer ask(const Values& wanted, bool online) noexcept;

    // --- service side -----------------------------------------------------------------------------------------------------
    void step(ecat::Master& bus, std::size_t slave);

private:
    void publish() noexcept;
    void finish(bool well) noexcept;
    [[nodiscard]] bool answered(ecat::Master& bus);

    Values asked_{no_limit, no_limit};
    std::uint32_t request_ = 0;  // 0: nothing was ever asked for
    bool away_ = false;

    std::array<std::atomic<std::int64_t>, most> wanted_{};
    std::atomic<std::uint32_t> wanted_request_{0};
    std::atomic<std::uint64_t> answer_{0};  // request << 1 | taken

    std::array<Object, most> objects_{};
    Values writing_{};
    std::uint32_t served_ = 0;
    std::size_t place_ = most;
    bool reading_ = false;
    ecat::SdoTicket ticket_ = 0;
};

}  // namespace taktwerk::axes::cia402
