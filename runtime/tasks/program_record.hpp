#pragma once
// What the cycle keeps of each program beside its code: how it stands, how it was asked to start or stop, and why it failed.

#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>

#include "programs/api/program.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/tasks/fault_text.hpp"
#include "runtime/tasks/program_groups.hpp"
#include "runtime/tasks/program_requests.hpp"
#include "runtime/tasks/task_watch.hpp"

namespace taktwerk::runtime {

/// start() and stop() of a program run on the service side: the cycle asks, the service answers. While the handshake is not
/// `none` no task of the program runs, nothing reads its variables, and start() and stop() never run beside its tasks.
///   cycle    none -> start_asked    any -> stop_asked    started, failed -> none
///   service  start_asked -> started or failed    stop_asked -> none or failed, once its slower tasks have ended
/// What the service side has come to it puts into HookAnswer; the next cycle makes it the handshake, so that the cycle has one place where it
/// learns of it.
enum class Handshake : std::uint8_t { none, start_asked, started, stop_asked, failed };

/// From the service side to the next cycle: to what was asked, what came of it. One word.
class HookAnswer {
public:
    /// Service side. Not while waits_for(asked).
    void put(Handshake asked, Handshake next) noexcept {
        word_.store(static_cast<std::uint16_t>(present | static_cast<unsigned>(asked) << 4 | static_cast<unsigned>(next)),
                    std::memory_order_release);
    }
    /// Service side: it was answered already, and no cycle has come since.
    [[nodiscard]] bool waits_for(Handshake asked) const noexcept {
        const unsigned word = word_.load(std::memory_order_acquire);
        return word != 0 && (word >> 4 & 0xFu) == static_cast<unsigned>(asked);
    }
    /// Cycle: `take(asked, next)` where there is one.
    template <class Take>
    void take(Take&& take) noexcept {
        if (word_.load(std::memory_order_relaxed) == 0) return;
        const unsigned word = word_.exchange(0, std::memory_order_acq_rel);
        take(static_cast<Handshake>(word >> 4 & 0xFu), static_cast<Handshake>(word & 0xFu));
    }

private:
    static constexpr unsigned present = 0x100;
    std::atomic<std::uint16_t> word_{0};
};

/// Which task has stopped its program by not keeping its time. Written by the cycle, read by any thread.
class StoppedByTask {
public:
    void set(std::size_t task, TaskVerdict verdict) noexcept {
        word_.store(static_cast<std::uint32_t>(task + 1) << 8 | static_cast<std::uint32_t>(verdict), std::memory_order_relaxed);
    }
    void clear() noexcept { word_.store(0, std::memory_order_relaxed); }
    /// Its place among the machine's tasks; nothing: none has.
    [[nodiscard]] std::optional<std::size_t> task() const noexcept {
        const auto word = word_.load(std::memory_order_relaxed);
        return word == 0 ? std::nullopt : std::optional<std::size_t>{(word >> 8) - 1};
    }
    [[nodiscard]] TaskVerdict verdict() const noexcept { return static_cast<TaskVerdict>(word_.load(std::memory_order_relaxed) & 0xFF); }

private:
    std::atomic<std::uint32_t> word_{0};
};

struct ProgramRecord {
    ProgramRecord(axes::AxisRequests& axes, WatchedGroups& of_axes, std::span<AxisClaims> claims, std::uint16_t program)
        : requests(axes, claims, program), groups(of_axes, claims, program) {}

    [[nodiscard]] bool running() const noexcept { return state == ProgramState::running; }
    [[nodiscard]] bool start_pending() const noexcept {
        const auto asked = handshake.load(std::memory_order_relaxed);
        return asked == Handshake::start_asked || asked == Handshake::started;
    }

    ProgramState state = ProgramState::stopped;
    std::atomic<Handshake> handshake{Handshake::none};
    HookAnswer hook;
    std::uint64_t start_after = 0;       ///< stop levels raised when its start was given; 0: it starts by itself
    StoppedByTask stopped_by;            ///< with state fault, and until the next start
    FaultText fault;                     ///< the cycle's; handed over with stop_asked
    TaskContext::Undeclared undeclared;  ///< what it uses without having declared it; since its start
    ProgramRequests requests;
    ProgramGroups groups;
    bool has_base_task = false;
};

/// As MachineConfig::programs. A record stays where it is.
using ProgramRecords = std::deque<ProgramRecord>;

}  // namespace taktwerk::runtime
