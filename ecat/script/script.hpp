#pragma once
// Everything acyclic on the bus is a script: a C++20 coroutine that runs a few lines, waits for an answer or a time, runs on.
//
//   Script<T>      a lazy task. It starts when somebody awaits it, or when a Runner owns it; it returns a T.
//   Runner         owns one Script and resumes it: step(now). It is done(), or it waits for something.
//   Waiting        what a leaf waits for: asked at each step whether it is ready. Times, other scripts, locks: waits.hpp.
//
// Service side only, one thread, allocates freely, throws nothing itself (an exception in a script ends the program: scripts
// return Result). Nobody reads a clock: `now` is what step() was given.
//
// No symmetric transfer: each suspension goes back to the Runner, which resumes whoever is next. So the depth of the stack is
// one, whatever the optimisation level or sanitizer. Two rules keep g++ 12 honest: no co_await inside ?: or among the
// arguments of a call, and arguments with destructors are named locals, not temporaries.

#include <coroutine>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "core/time.hpp"

namespace taktwerk::ecat {

/// What a suspended script waits for. Lives in the coroutine's frame while it waits.
class Waiting {
public:
    virtual bool ready(Instant now) = 0;

protected:
    ~Waiting() = default;
};

/// The thread of one root script and all it awaits.
struct ScriptThread {
    Instant now{};
    Waiting* waiting = nullptr;         ///< null: resume at once
    std::coroutine_handle<> current{};  ///< whom to resume; null: finished
};

namespace script_detail {

struct PromiseBase {
    ScriptThread* thread = nullptr;
    std::coroutine_handle<> continuation{};

    std::suspend_always initial_suspend() noexcept { return {}; }
    struct Final {
        bool await_ready() noexcept { return false; }
        template <class Promise>
        void await_suspend(std::coroutine_handle<Promise> handle) noexcept {
            handle.promise().thread->current = handle.promise().continuation;
        }
        void await_resume() noexcept {}
    };
    Final final_suspend() noexcept { return {}; }
    void unhandled_exception() noexcept { std::terminate(); }
};

template <class T>
struct Promise;

}  // namespace script_detail

template <class T = void>
class [[nodiscard]] Script {
public:
    using promise_type = script_detail::Promise<T>;
    using Handle = std::coroutine_handle<promise_type>;

    explicit Script(Handle handle) noexcept : handle_(handle) {}
    Script(Script&& other) noexcept : handle_(std::exchange(other.handle_, {})) {}
    Script& operator=(Script&& other) noexcept {
        if (this != &other) {
            if (handle_) handle_.destroy();
            handle_ = std::exchange(other.handle_, {});
        }
        return *this;
    }
    Script(const Script&) = delete;
    Script& operator=(const Script&) = delete;
    ~Script() {
        if (handle_) handle_.destroy();
    }

    // Awaiting a script runs it to its end in the awaiter's thread.
    bool await_ready() const noexcept { return false; }
    template <class Promise>
    void await_suspend(std::coroutine_handle<Promise> parent) noexcept {
        handle_.promise().thread = parent.promise().thread;
        handle_.promise().continuation = parent;
        parent.promise().thread->current = handle_;
    }
    T await_resume() { return handle_.promise().take(); }

    [[nodiscard]] Handle handle() const noexcept { return handle_; }

private:
    Handle handle_;
};

namespace script_detail {

template <class T>
struct Promise : PromiseBase {
    std::optional<T> value;
    Script<T> get_return_object() noexcept { return Script<T>{std::coroutine_handle<Promise>::from_promise(*this)}; }
    void return_value(T result) { value.emplace(std::move(result)); }
    T take() { return std::move(*value); }
};

template <>
struct Promise<void> : PromiseBase {
    Script<void> get_return_object() noexcept { return Script<void>{std::coroutine_handle<Promise>::from_promise(*this)}; }
    void return_void() noexcept {}
    void take() noexcept {}
};

}  // namespace script_detail

/// Owns a root script and runs it step by step.
template <class T = void>
class BasicRunner {
public:
    explicit BasicRunner(Script<T> script) : script_(std::move(script)), thread_(std::make_unique<ScriptThread>()) {
        script_.handle().promise().thread = thread_.get();
        thread_->current = script_.handle();
    }

    /// Runs the script as far as it gets at this time.
    void step(Instant now) {
        thread_->now = now;
        while (thread_->current) {
            if (thread_->waiting != nullptr && !thread_->waiting->ready(now)) return;
            thread_->waiting = nullptr;
            const std::coroutine_handle<> next = thread_->current;
            next.resume();
        }
    }
    [[nodiscard]] bool done() const noexcept { return !thread_->current; }
    /// Only when done(), once.
    [[nodiscard]] T result() { return script_.handle().promise().take(); }

private:
    Script<T> script_;
    std::unique_ptr<ScriptThread> thread_;  ///< stays where it is when the runner moves
};

using Runner = BasicRunner<void>;

/// Base of leaf awaitables: suspends, is asked at each step, gives a result.
template <class Derived>
class Leaf : public Waiting {
public:
    bool await_ready() const noexcept { return false; }
    template <class Promise>
    void await_suspend(std::coroutine_handle<Promise> handle) noexcept {
        thread_ = handle.promise().thread;
        thread_->waiting = this;
    }

protected:
    ~Leaf() = default;
    ScriptThread* thread_ = nullptr;
};

}  // namespace taktwerk::ecat
