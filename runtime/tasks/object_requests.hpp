#pragma once
// The object requests (SDO) of all programs: asked for on their tasks' threads, carried out by the service side through the
// master's mailbox queue, handed back between two cycles. Fixed places, no lock, no allocation outside the service side.
//
//   a place:   free -> filling -> asked   a task's thread (base or slower task)
//              asked -> working -> arrived   service side
//              arrived -> answered           cycle, at its inbox: what comes from outside comes at one point of the cycle
//              answered -> free              a task's thread, or the cycle before the program starts again
// A request that is released while it works is `abandoned`; the service side frees it when the slave has answered.

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "core/object_access.hpp"
#include "core/recorder.hpp"
#include "core/time.hpp"
#include "ecat/master.hpp"

namespace taktwerk::runtime {

class ObjectRequests {
public:
    /// Requests of one program under way at once.
    static constexpr std::size_t places_per_program = 16;
    /// Those of them that the master is given at once; the others wait here, where they can be released without a trace.
    static constexpr std::size_t at_work = 4;

    ObjectRequests(std::size_t programs, std::size_t devices);
    ~ObjectRequests();

    /// What the tasks of a program are handed. Lives as long as this.
    [[nodiscard]] ObjectAccess& of(std::size_t program) noexcept;

    /// Cycle: answers that have arrived become visible, and go to the recorder where there is one. Real-time safe.
    void take_answers(Recorder* recorder, Instant now) noexcept;
    /// Cycle: the program is about to start, and none of its tasks runs. Real-time safe.
    void open(std::size_t program) noexcept;
    /// Cycle: one of its tasks may go on without an end, and shall ask nobody for anything any more. Until open(). Real-time safe.
    void close(std::size_t program) noexcept;
    /// Service side: starts what was asked for, fetches what was answered.
    void step(ecat::Master& bus);

private:
    class OfProgram;
    std::vector<std::unique_ptr<OfProgram>> programs_;
};

}  // namespace taktwerk::runtime
