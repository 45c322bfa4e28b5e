#pragma once
// Which version of a machine is the active one, how that changes, and which one starts.
//
// An activation is a folder: `bundle` links the version, `before` links the activation that was in force until then, `starts` counts starts that did not
// reach operation, `worked` is there once one has. It is complete and on the disk before the link `current` is renamed to it, and that one rename is the
// whole change: killed at any instant, the old version is active or the new one. Going back renames the link to what `before` says, and needs
// nothing written but the link, so that it works on a full disk. Not real-time.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "runtime/bundle/audit.hpp"
#include "runtime/bundle/bundle_store.hpp"

namespace taktwerk::runtime {

struct Activation {
    std::uint64_t number = 0;
    std::string version;
    unsigned failed_starts = 0;  ///< since it was activated, while it never worked
    bool worked = false;         ///< the machine has reached operation with it
};

/// The active one, then those to go back to, nearest first. Empty: none is active.
[[nodiscard]] std::vector<Activation> activations_of(const BundleStore& store, const std::string& machine);

/// What an activation or a way back has changed.
struct Switched {
    std::string from, to;          ///< versions; from: empty where none was active
    std::string next_back;         ///< the version that rollback would come to now; empty: none
    std::vector<Error> remarks{};  ///< what did not work and does not matter for the machine
};

/// Its files are whole, it fits this computer, and who stands for it is trusted. The active one again: a new activation, whose failed starts are counted
/// from 0. Errors: bundle.unknown, bundle.sum, those of fits() and Trust::judge(), bundle.not_written.
[[nodiscard]] Result<Switched> activate(const BundleStore& store, const std::string& machine, const std::string& version,
                                        const Trust& trust, const Host& host, const Deed& deed);
/// Errors: bundle.none_active, bundle.no_way_back, bundle.sum, those of fits(), bundle.not_written.
[[nodiscard]] Result<Switched> roll_back(const BundleStore& store, const std::string& machine, const Host& host, const Deed& deed);

/// What a machine starts from.
struct BundleStart {
    UnpackedBundle bundle;
    std::filesystem::path state;       ///< where its relative directories are
    std::filesystem::path activation;  ///< for start_succeeded()
    std::vector<Error> remarks{};      ///< to be said loudly: another version than the active one was taken, and why
    OwnedFd held;                      ///< says that a machine runs from it
    bool fell_back = false;            ///< the remarks say from what, and why
};

inline constexpr unsigned usual_tries = 3;

/// Chooses, and counts the start. A version that is damaged, is not for this runtime, or has `tries` starts behind it of which none reached operation is
/// left for the one before it, which then is the active one. One that has worked once is never left because it does not start: that is the
/// machine's trouble and not the bundle's. Errors: bundle.unknown, bundle.none_active; bundle.machine_runs (one runs from a version of this machine:
/// nothing is counted); of the active one where there is nothing to go back to.
[[nodiscard]] Result<BundleStart> begin_start(const BundleStore& store, const std::string& machine, unsigned tries, const Host& host,
                                              const Deed& deed);
/// The machine has reached operation. Errors: bundle.not_written.
[[nodiscard]] Result<void> start_succeeded(const std::filesystem::path& activation);
/// Somebody ended this start before it could succeed: it does not count.
void start_was_ended(const std::filesystem::path& activation);

}  // namespace taktwerk::runtime
