#pragma once
// Argon2id takes a tenth of a second and 64 MiB on purpose: one thread of its own does it, one after another, so that values and stops flow meanwhile.

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace taktwerk::hmi::web {

class PasswordDesk {
public:
    static constexpr std::size_t most_waiting = 4;  ///< of each turn
    enum class Turn : std::uint8_t {
        last,
        before_strangers
    };  ///< the second: of who has been here before, whom no crowd of strangers keeps out
    using Done = std::function<void(bool matches)>;

    PasswordDesk();
    /// What waits is not done any more.
    ~PasswordDesk();
    PasswordDesk(const PasswordDesk&) = delete;
    PasswordDesk& operator=(const PasswordDesk&) = delete;

    /// `hash`: empty for a user who is not there, which takes as long. `done` is called by the desk's thread. False: too many wait, nothing was taken.
    bool ask(std::string hash, std::string password, Turn turn, Done done);

private:
    struct Task {
        std::string hash, password;
        Turn turn;
        Done done;
    };
    void work();

    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Task> tasks_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace taktwerk::hmi::web
