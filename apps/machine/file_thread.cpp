#include "apps/machine/file_thread.hpp"

#include <condition_variable>
#include <csignal>
#include <mutex>
#include <utility>

namespace taktwerk::apps {

namespace {

constexpr auto look_again = std::chrono::milliseconds{2};

}  // namespace

struct FileThread::Shared {
    std::function<Result<void>()> drain, close;
    std::function<void(const Error&)> failed;
    std::mutex mutex;
    std::condition_variable asked, done;
    bool ending = false, ended = false, broken = false;

    void serve() {
        for (bool last = false;;) {
            if (!broken)
                if (auto ok = drain(); !ok) {
                    broken = true;
                    failed(ok.error());
                }
            if (last)
                if (auto ok = close(); !ok && !broken) {
                    broken = true;
                    failed(ok.error());
                }
            std::unique_lock lock{mutex};
            if (last) {
                ended = true;
                done.notify_all();
                return;
            }
            last = asked.wait_for(lock, look_again, [this] { return ending; });
        }
    }
};

FileThread::FileThread(std::string what, std::function<Result<void>()> drain, std::function<Result<void>()> close,
                       std::function<void(const Error&)> failed)
    : what_(std::move(what)), shared_(std::make_shared<Shared>()) {
    shared_->drain = std::move(drain);
    shared_->close = std::move(close);
    shared_->failed = std::move(failed);
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread{[shared = shared_] { shared->serve(); }};
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

FileThread::~FileThread() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard lock{shared_->mutex};
        shared_->ending = true;
        shared_->asked.notify_all();
    }
    thread_.join();
}

FileThread::End FileThread::finish(Duration patience) {
    if (!thread_.joinable()) return shared_->broken ? End::broken : End::complete;
    bool home = false;
    {
        std::unique_lock lock{shared_->mutex};
        shared_->ending = true;
        shared_->asked.notify_all();
        home = shared_->done.wait_for(lock, patience, [this] { return shared_->ended; });
    }
    if (!home) {
        thread_.detach();
        return End::hangs;
    }
    thread_.join();
    return shared_->broken ? End::broken : End::complete;
}

}  // namespace taktwerk::apps
