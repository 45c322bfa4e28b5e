#include "apps/terminal/line_writer.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <csignal>
#include <deque>
#include <mutex>
#include <utility>

namespace taktwerk::apps {

namespace {

/// A pipe that says it has room takes so much without waiting (pipe(7), PIPE_BUF is 4096); less, so that a terminal does so, too.
constexpr std::size_t piece = 512;
constexpr int look_again_ms = 50;

}  // namespace

struct LineWriter::Shared {
    int descriptor = -1;
    std::function<std::string(std::uint64_t)> missing;
    std::mutex mutex;
    std::condition_variable something, done;
    std::deque<std::string> lines;
    std::size_t bytes = 0;
    std::uint64_t dropped = 0, unsaid = 0;  // counted; not yet told
    bool ending = false, ended = false;
    std::atomic<bool> abandoned{false};

    /// False: nobody takes it any more.
    bool write_out(std::string_view text) const {
        while (!text.empty()) {
            if (abandoned.load(std::memory_order_relaxed)) return false;
            pollfd ready{descriptor, POLLOUT, 0};
            if (::poll(&ready, 1, look_again_ms) == 0) continue;
            const auto put = ::write(descriptor, text.data(), std::min(text.size(), piece));
            if (put > 0) text.remove_prefix(static_cast<std::size_t>(put));
            else if (put < 0 && errno != EINTR && errno != EAGAIN) return false;
        }
        return true;
    }

    void serve() {
        std::unique_lock lock{mutex};
        for (;;) {
            something.wait(lock, [this] { return !lines.empty() || unsaid > 0 || ending; });
            if (lines.empty() && unsaid == 0) break;
            std::string next;
            std::uint64_t count = 1;
            const bool says_missing = lines.empty();
            if (says_missing) {
                count = std::exchange(unsaid, 0);
                next = missing(count);
            } else {
                next = std::move(lines.front());
                lines.pop_front();
            }
            lock.unlock();
            const bool out = write_out(next);
            lock.lock();
            if (!says_missing) bytes -= next.size();
            if (!out) {
                if (!says_missing) ++dropped;
                // A full disk may have room again: the next line tries. Of those that could not be said nobody needs to hear twice.
                if (ending || abandoned.load(std::memory_order_relaxed)) break;
            }
        }
        ended = true;
        done.notify_all();
    }
};

LineWriter::LineWriter(int descriptor, std::function<std::string(std::uint64_t)> missing) : shared_(std::make_shared<Shared>()) {
    shared_->descriptor = descriptor;
    shared_->missing = std::move(missing);
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread{[shared = shared_] { shared->serve(); }};
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

LineWriter::~LineWriter() { finish(std::chrono::seconds{1}); }

void LineWriter::put(std::string lines) {
    const std::lock_guard lock{shared_->mutex};
    if (shared_->ending || shared_->bytes + lines.size() > most_bytes) {
        ++shared_->dropped;
        if (!shared_->ending) ++shared_->unsaid;
        return;
    }
    shared_->bytes += lines.size();
    shared_->lines.push_back(std::move(lines));
    shared_->something.notify_one();
}

std::uint64_t LineWriter::dropped() const {
    const std::lock_guard lock{shared_->mutex};
    return shared_->dropped;
}

void LineWriter::finish(Duration patience) {
    if (!thread_.joinable()) return;
    bool home = false;
    {
        std::unique_lock lock{shared_->mutex};
        shared_->ending = true;
        shared_->something.notify_one();
        const auto ended = [this] { return shared_->ended; };
        home = shared_->done.wait_for(lock, patience, ended);
        if (!home) {
            shared_->abandoned.store(true, std::memory_order_relaxed);
            // It looks every look_again_ms, unless the kernel holds it.
            home = shared_->done.wait_for(lock, std::chrono::milliseconds{4 * look_again_ms}, ended);
        }
    }
    if (home) thread_.join();
    else thread_.detach();  // it holds nothing but what it shares
}

}  // namespace taktwerk::apps
