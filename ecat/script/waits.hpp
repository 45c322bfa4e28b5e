#pragma once
// What a script can wait for besides an answer: a time, other scripts, a lock.
//
//   until(t)       waits for a machine time.      all(scripts)   runs scripts side by side, waits for the last;
//   pause(d)       the same, from now on.         all(scripts, n)   n of them at a time.
//   time()         the time of this step          ScriptLock     one at a time

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "ecat/script/script.hpp"

namespace taktwerk::ecat {

/// co_await time(): the time of this step, without waiting.
class TimeNow {
public:
    bool await_ready() const noexcept { return false; }
    template <class Promise>
    bool await_suspend(std::coroutine_handle<Promise> handle) noexcept {
        now_ = handle.promise().thread->now;
        return false;
    }
    [[nodiscard]] Instant await_resume() const noexcept { return now_; }

private:
    Instant now_{};
};
[[nodiscard]] inline TimeNow time() noexcept { return {}; }

/// co_await until(t): goes on at the first step at or after t; gives the time of that step.
class Until final : public Leaf<Until> {
public:
    explicit Until(Instant at) noexcept : at_(at) {}
    bool ready(Instant now) override { return now >= at_; }
    Instant await_resume() const noexcept { return thread_->now; }

private:
    Instant at_;
};
[[nodiscard]] inline Until until(Instant at) noexcept { return Until{at}; }

/// co_await pause(d): the same, counted from this step.
class Pause final : public Leaf<Pause> {
public:
    explicit Pause(Duration length) noexcept : length_(length) {}
    bool ready(Instant now) override {
        if (!started_) {
            started_ = true;
            at_ = now + length_;
        }
        return now >= at_;
    }
    Instant await_resume() const noexcept { return thread_->now; }

private:
    Duration length_;
    Instant at_{};
    bool started_ = false;
};
[[nodiscard]] inline Pause pause(Duration length) noexcept { return Pause{length}; }

/// co_await all(scripts): runs them side by side, each in its own thread; goes on when the last has ended. With `at_once` the next
/// starts when one of so many ends: who speaks to hundreds of slaves must not make each of them wait for all the others.
class All final : public Leaf<All> {
public:
    All(std::vector<Script<void>> scripts, std::size_t at_once) : at_once_(at_once) {
        runners_.reserve(scripts.size());
        for (auto& script : scripts) runners_.emplace_back(std::move(script));
    }
    bool ready(Instant now) override {
        std::size_t running = 0;
        while (first_ < runners_.size() && runners_[first_].done()) ++first_;
        for (std::size_t i = first_; i < runners_.size() && running < at_once_; ++i) {
            if (!runners_[i].done()) runners_[i].step(now);
            running += runners_[i].done() ? 0 : 1;
        }
        return running == 0;
    }
    void await_resume() const noexcept {}

private:
    std::vector<Runner> runners_;
    std::size_t at_once_;
    std::size_t first_ = 0;  ///< all before it have ended
};

[[nodiscard]] inline All all(std::vector<Script<void>> scripts, std::size_t at_once = std::numeric_limits<std::size_t>::max()) {
    return All{std::move(scripts), at_once};
}

/// One at a time: a slave's mailbox has one conversation. co_await lock.acquire(); ... lock.release().
class ScriptLock {
public:
    class Acquire final : public Leaf<Acquire> {
    public:
        explicit Acquire(ScriptLock& lock) noexcept : lock_(lock) {}
        bool ready(Instant) override {
            if (lock_.taken_) return false;
            lock_.taken_ = true;
            return true;
        }
        void await_resume() const noexcept {}

    private:
        ScriptLock& lock_;
    };
    [[nodiscard]] Acquire acquire() noexcept { return Acquire{*this}; }
    void release() noexcept { taken_ = false; }
    [[nodiscard]] bool taken() const noexcept { return taken_; }

private:
    bool taken_ = false;
};

/// Holds a ScriptLock until it goes out of scope, also when the script is destroyed half-way.
class ScriptLockGuard {
public:
    explicit ScriptLockGuard(ScriptLock& taken) noexcept : lock_(&taken) {}
    ~ScriptLockGuard() { lock_->release(); }
    ScriptLockGuard(const ScriptLockGuard&) = delete;
    ScriptLockGuard& operator=(const ScriptLockGuard&) = delete;

private:
    ScriptLock* lock_;
};

}  // namespace taktwerk::ecat
