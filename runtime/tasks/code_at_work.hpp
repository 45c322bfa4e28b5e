#pragma once
// Whose code a thread is running: the line about a crash names the program and the task, not an address alone.

namespace taktwerk::runtime {

struct CodeAtWork {
    const char* program = nullptr;  ///< nullptr: none of a program's code
    const char* part = nullptr;     ///< task, or "start()", "stop()"
};

/// Of the calling thread. Async-signal-safe, real-time safe.
[[nodiscard]] CodeAtWork code_at_work() noexcept;

/// For its own lifetime. The names outlive it. Real-time safe.
class ProgramCode {
public:
    ProgramCode(const char* program, const char* part) noexcept;
    ~ProgramCode();
    ProgramCode(const ProgramCode&) = delete;
    ProgramCode& operator=(const ProgramCode&) = delete;
};

/// A thread that runs programs has a place beside its stack on which a signal handler can still speak: a program that recurses without
/// end has used up the stack itself. Once per thread, as long as it lives. Not real-time.
class CrashStack {
public:
    CrashStack() noexcept;
    ~CrashStack();
    CrashStack(const CrashStack&) = delete;
    CrashStack& operator=(const CrashStack&) = delete;

private:
    void* memory_ = nullptr;
};

}  // namespace taktwerk::runtime
