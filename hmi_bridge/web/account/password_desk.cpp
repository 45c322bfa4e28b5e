#include "hmi_bridge/web/account/password_desk.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "hmi_bridge/web/account/password.hpp"

namespace taktwerk::hmi::web {

PasswordDesk::PasswordDesk() : thread_([this] { work(); }) {}

PasswordDesk::~PasswordDesk() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    more_.notify_one();
    thread_.join();
}

bool PasswordDesk::ask(std::string hash, std::string password, Turn turn, Done done) {
    {
        const std::lock_guard lock(mutex_);
        const auto same = [turn](const Task& task) { return task.turn == turn; };
        if (static_cast<std::size_t>(std::count_if(tasks_.begin(), tasks_.end(), same)) >= most_waiting) return false;
        const auto at = turn == Turn::last ? tasks_.end() : std::find_if_not(tasks_.begin(), tasks_.end(), same);
        tasks_.insert(at, {std::move(hash), std::move(password), turn, std::move(done)});
    }
    more_.notify_one();
    return true;
}

void PasswordDesk::work() {
    constexpr int behind_the_pages = 3;  // and not so far that a busy computer lets nobody log in
    ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), behind_the_pages);
    const auto nobodys = hash_password(random_token());  // as dear as a user's
    while (true) {
        Task task;
        {
            std::unique_lock lock(mutex_);
            more_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
            if (ends_) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        const bool known = !task.hash.empty();
        const bool matches = password_matches(known || !nobodys ? task.hash : *nobodys, task.password);
        task.done(matches && known);
    }
}

}  // namespace taktwerk::hmi::web
