#pragma once
// Did the run before this one end by itself? A mark beside the machine's socket stands while it runs and goes with an ordered end. What finds it again was
// preceded by a run that was killed, crashed, or hung: then nobody who restarts it (a service manager does so by itself) may set the machine in motion.
// After a restart of the computer the mark counts for nothing: switching on is an ordinary start.

#include <optional>
#include <string>

#include "core/result.hpp"

namespace taktwerk::apps {

/// Not real-time; before and behind a run.
class UnfinishedRun {
public:
    struct Before {
        long process = 0;  ///< of the run that did not end; 0: its mark does not say, and nobody knows how it ended
    };

    /// `path`: of the mark. `boot`: what names this start of the computer (boot_of_this_computer()).
    static UnfinishedRun begin(std::string path, const std::string& boot);
    /// Leaves the mark where it is: a run that is destroyed without ended() has not ended in order.
    ~UnfinishedRun() = default;

    /// The run before this one, if it did not end in order.
    [[nodiscard]] const std::optional<Before>& before() const noexcept { return before_; }
    /// run.mark: the mark of this one cannot be written, so that the next will not see its crash. What was there stays.
    [[nodiscard]] const std::optional<Error>& trouble() const noexcept { return trouble_; }
    /// This one has.
    void ended() noexcept;

private:
    UnfinishedRun(std::string path, std::optional<Before> before) : path_(std::move(path)), before_(before) {}
    std::string path_;
    std::optional<Before> before_;
    std::optional<Error> trouble_;
};

/// /proc/sys/kernel/random/boot_id; empty where it cannot be read.
[[nodiscard]] std::string boot_of_this_computer();

}  // namespace taktwerk::apps
