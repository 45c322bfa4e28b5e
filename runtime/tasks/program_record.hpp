#pragma once
// What the cycle keeps of each program beside its code: how it stands, how it was asked to start or stop, and why it failed.

#include <atomic>
#include <cstdint>
#include <deque>

#include "programs/api/program.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/tasks/fault_text.hpp"
#include "runtime/tasks/program_requests.hpp"

namespace taktwerk::runtime {

/// start() and stop() of a program run on the service side: the cycle asks, the service answers. While the handshake is not
/// `none` no task of the program runs, nothing reads its variables, and start() and stop() never run beside its tasks.
///   cycle    none -> start_asked    any -> stop_asked    started, failed -> none
///   service  start_asked -> started or failed    stop_asked -> none or failed, once its slower tasks have ended
enum class Handshake : std::uint8_t { none, start_asked, started, stop_asked, failed };

struct ProgramRecord {
    ProgramRecord(axes::AxisRequests& axes, std::span<AxisClaims> claims, std::uint16_t program) : requests(axes, claims, program) {}

    [[nodiscard]] bool running() const noexcept { return state == ProgramState::running; }
    [[nodiscard]] bool start_pending() const noexcept {
        const auto asked = handshake.load(std::memory_order_relaxed);
        return asked == Handshake::start_asked || asked == Handshake::started;
    }

    ProgramState state = ProgramState::stopped;
    std::atomic<Handshake> handshake{Handshake::none};
    std::uint64_t start_after = 0;       ///< stop levels raised when its start was given; 0: it starts by itself
    FaultText fault;                     ///< the cycle's; handed over with stop_asked
    TaskContext::Undeclared undeclared;  ///< what it uses without having declared it; since its start
    ProgramRequests requests;
    bool has_base_task = false;
};

/// As MachineConfig::programs. A record stays where it is.
using ProgramRecords = std::deque<ProgramRecord>;

}  // namespace taktwerk::runtime
