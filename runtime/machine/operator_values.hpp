#pragma once
// The variables of programs that people write (Declaration::operator_value): what was given and not taken yet, who holds which button and
// until when. A value reaches its variable at the beginning of a scan of its task, or, while its program rests, in the cycle. Real-time safe.

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "runtime/machine/hand_motion.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/tasks/program_host.hpp"
#include "runtime/tasks/slow_task.hpp"

namespace taktwerk::runtime {

class OperatorValues {
public:
    /// A button whose holder has said nothing for so long is let go: as long as the lease of a jog is at first.
    static constexpr Duration lease = std::chrono::milliseconds{200};

    explicit OperatorValues(const ProgramHost& host);

    /// As OperatorAction::set_value. `runs`: its program does.
    Verdict write(const OperatorCommand& command, Instant now, bool runs, bool emergency) noexcept;
    /// Buttons let go, those of a program, of a client; and those whose lease is over, at the beginning of step 6.
    void let_go(std::size_t program) noexcept;
    void let_go_of(std::uint32_t client) noexcept;
    void let_go_all() noexcept;
    void end_leases(Instant now) noexcept;

    /// A base task begins a scan.
    void apply(std::size_t task) noexcept;
    /// A slow task is released: what is to be written when it begins, at most `out.size()`. Returns how many.
    std::size_t take(std::size_t task, std::span<SlowTask::Write> out) noexcept;
    /// The program rests, and nothing of it runs: written now, and shown in `shown` (as the host's variables). False: there was nothing.
    bool apply_at_rest(std::size_t program, std::span<double> shown) noexcept;

    /// How many operator values a task has.
    [[nodiscard]] std::size_t count_of(std::size_t task) const noexcept { return of_task_[task].size(); }
    /// Of a variable of the layout; -1: nobody writes it.
    [[nodiscard]] std::int32_t program_of(std::size_t variable) const noexcept;

private:
    struct Value {
        ProgramHost::OperatorValue of;
        VariableType type = VariableType::real;
        std::size_t program = 0;
        double given = 0;
        bool waits = false;  // given, and not in its variable yet
        bool held = false;   // a button
        bool falls = false;  // let go before its task saw the press: once it has, it is 0
        std::uint32_t client = 0;
        Instant until{};
    };
    static void release(Value& value) noexcept;
    static void lift(Value& value) noexcept;
    static void taken(Value& value) noexcept;

    const ProgramHost& host_;
    std::vector<Value> values_;
    std::vector<std::int32_t> by_variable_;            // place in values_, or -1
    std::vector<std::vector<std::uint16_t>> of_task_;  // as host.tasks(): places in values_
};

}  // namespace taktwerk::runtime
