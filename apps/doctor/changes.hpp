#pragma once
// `--apply` and `--revert`: what was there before is written down, and on the disk, before anything is changed. Whatever happens in between, the way
// back is known. Not real-time; one process at a time.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/doctor/ethernet_port.hpp"
#include "apps/doctor/finding.hpp"
#include "core/result.hpp"

namespace taktwerk::apps {

/// One change that was written down.
struct AppliedChange {
    HostChange change;
    std::optional<std::string> before;        ///< nothing: there was no such file
    std::vector<std::string> made_folders{};  ///< for it, the deepest first
    std::string boot{};                       ///< of the computer, when it was done
};

/// What became of one.
struct ChangeOutcome {
    std::string words;             ///< "/proc/sys/net/core/rmem_max: 212992 -> 2097152"
    std::optional<Error> error{};  ///< it could not be done, or not be taken back
    bool left = false;             ///< taken back it was not, for somebody else has changed it since
};

class Changes {
public:
    /// Below `root`; the record of them is `root`/var/lib/taktwerk/doctor/applied.json. `ports` outlives this.
    Changes(std::filesystem::path root, EthernetPorts& ports) : root_(std::move(root)), ports_(ports) {}

    /// What is as wanted already is not mentioned. Errors: doctor.record (nothing was changed).
    [[nodiscard]] Result<std::vector<ChangeOutcome>> apply(const std::vector<HostChange>& wanted);
    /// The same of what belongs together: first what is for the next start of the computer. Where that cannot be done nothing of it is: a setting of now
    /// alone would be gone with a restart, and nobody would see it any more.
    [[nodiscard]] Result<std::vector<ChangeOutcome>> apply_together(const std::vector<HostChange>& wanted);
    /// The newest first. What somebody else has changed since is left alone and said, and stays recorded: with it what was there before. Errors:
    /// doctor.record.
    [[nodiscard]] Result<std::vector<ChangeOutcome>> revert();
    /// Errors: doctor.record: the record is there and cannot be understood.
    [[nodiscard]] Result<std::vector<AppliedChange>> recorded() const;

private:
    [[nodiscard]] std::filesystem::path below(const std::string& path) const { return root_ / path.substr(path.front() == '/' ? 1 : 0); }
    [[nodiscard]] std::optional<std::string> now(const HostChange& change) const;
    [[nodiscard]] Result<void> put(const HostChange& change, const std::string& value) const;
    [[nodiscard]] Result<void> take_back(const AppliedChange& applied) const;
    [[nodiscard]] Result<void> record(const std::vector<AppliedChange>& all) const;
    [[nodiscard]] std::vector<std::string> missing_folders(const std::string& path) const;
    [[nodiscard]] std::string boot() const;

    std::filesystem::path root_;
    EthernetPorts& ports_;
};

/// The record of changes as JSON, and back; errors: doctor.record.
[[nodiscard]] std::string record_text(const std::vector<AppliedChange>& all);
[[nodiscard]] Result<std::vector<AppliedChange>> read_record(const std::string& text);

}  // namespace taktwerk::apps
