#include "runtime/tasks/code_at_work.hpp"

#include <csignal>
#include <cstdlib>

namespace taktwerk::runtime {

namespace {

constexpr std::size_t crash_stack_bytes = std::size_t{64} << 10;

// Initialised without code: reading it in a signal handler needs nothing but the thread itself.
thread_local constinit CodeAtWork at_work{};

}  // namespace

CodeAtWork code_at_work() noexcept { return at_work; }

ProgramCode::ProgramCode(const char* program, const char* part) noexcept { at_work = {program, part}; }
ProgramCode::~ProgramCode() { at_work = {}; }

CrashStack::CrashStack() noexcept : memory_(std::malloc(crash_stack_bytes)) {
    if (memory_ == nullptr) return;
    stack_t stack{};
    stack.ss_sp = memory_;
    stack.ss_size = crash_stack_bytes;
    sigaltstack(&stack, nullptr);
}

CrashStack::~CrashStack() {
    if (memory_ == nullptr) return;
    stack_t off{};
    off.ss_flags = SS_DISABLE;
    sigaltstack(&off, nullptr);
    std::free(memory_);
}

}  // namespace taktwerk::runtime
