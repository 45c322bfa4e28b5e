#pragma once
// `taktwerk run --bundle MACHINE`: the run of a machine from the bundle that is active, and what of it counts as a start that worked.

#include <atomic>
#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "runtime/bundle/active_bundle.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::apps {

/// Where bundles are: as given, else the state directory of the service ($STATE_DIRECTORY), else /var/lib/taktwerk.
[[nodiscard]] std::filesystem::path bundle_root(const std::string& given);
/// Now, by whoever runs this process. One who came by sudo is called by both names.
[[nodiscard]] runtime::Deed deed_now();

class BundleRun {
public:
    explicit BundleRun(runtime::BundleStart start) : start_(std::move(start)) {}

    [[nodiscard]] const runtime::BundleStart& start() const noexcept { return start_; }
    /// "cell 1.4.0, made at 2026-11-26T05:12:00Z"
    [[nodiscard]] std::string title() const;
    /// The newest cycle; may be nullptr. Any one thread.
    void look(const runtime::Snapshot* snapshot) noexcept;
    [[nodiscard]] bool reached() const noexcept { return reached_.load(std::memory_order_acquire); }
    /// Writes down that the machine has reached operation, if it has and that is not written yet. Waits for a disk. Errors: bundle.not_written.
    [[nodiscard]] Result<void> work();
    /// It will not reach operation for a reason that has nothing to do with the version, such as a file that was asked for on the command line.
    void excuse() noexcept { excused_ = true; }
    [[nodiscard]] bool excused() const noexcept { return excused_; }
    /// The run has ended as somebody wanted, or is excused; if that was before it had reached operation, the start does not count.
    void ended_as_asked();

private:
    runtime::BundleStart start_;
    std::atomic<bool> reached_{false};
    bool written_ = false;  ///< of the thread that calls work()
    bool excused_ = false;  ///< before any thread and behind all
};

}  // namespace taktwerk::apps
