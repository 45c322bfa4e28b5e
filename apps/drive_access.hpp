#pragma once
// What the sub-commands of `taktwerk drive` share: one axis of one drive on a bus, its profile, and its parameters over SDO.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/bus.hpp"
#include "axes/port/drive_profile.hpp"

namespace taktwerk::apps {

struct DriveOptions {
    std::shared_ptr<BusOptions> bus;
    std::string drive;    ///< position or name on the bus
    std::string profile;  ///< instead of the machine file's, or of what the identity says
    int axis = 1;         ///< of a drive with several
};

/// The options that every sub-command has; `with_drive`: also which drive and axis.
[[nodiscard]] std::shared_ptr<DriveOptions> add_drive_options(CLI::App& sub);
void add_drive_choice(CLI::App& sub, DriveOptions& options);

class DriveAccess {
public:
    DriveAccess(BusSession& session, const ecat::Survey& survey, ecat::BusSlave& slave, std::shared_ptr<const axes::DriveProfile> profile,
                int axis)
        : session_(session), survey_(survey), slave_(&slave), profile_(std::move(profile)), axis_(axis) {}

    [[nodiscard]] const axes::DriveProfile& profile() const noexcept { return *profile_; }
    /// "slave 0 'x_drive' (sv33-e)", with the axis where there are several.
    [[nodiscard]] std::string subject() const;
    [[nodiscard]] const std::string& where() const noexcept { return session_.where(); }

    [[nodiscard]] Result<std::vector<std::byte>> read_bytes(const axes::ParameterAddress& address);
    [[nodiscard]] Result<std::int64_t> read(const axes::DriveParameter& parameter);
    [[nodiscard]] Result<void> write(const axes::DriveParameter& parameter, std::int64_t raw);
    /// Brings the bus up as the machine file has it, asks the drive by its control word to forget its fault (disabled, targets at rest),
    /// and ends when it has or after `patience`. True: no fault any more.
    [[nodiscard]] Result<bool> reset_fault(Duration patience);
    /// Bus time, so that drives keep up with what they store.
    void wait(Duration time);

private:
    [[nodiscard]] std::uint16_t index_of(const axes::ParameterAddress& address) const noexcept;
    BusSession& session_;
    const ecat::Survey& survey_;
    ecat::BusSlave* slave_;
    std::shared_ptr<const axes::DriveProfile> profile_;
    int axis_;
};

/// Opens the bus, finds the drive and its profile, and returns what `work` does.
int with_drive(const DriveOptions& options, const std::function<int(DriveAccess&)>& work);

/// The profiles that a machine file, or the installation, knows.
[[nodiscard]] std::vector<std::shared_ptr<const axes::DriveProfile>> known_profiles(const DriveOptions& options);
/// By name among them; the error names those that are there.
[[nodiscard]] Result<std::shared_ptr<const axes::DriveProfile>> profile_named(const DriveOptions& options, const std::string& name);

/// The kinds of drive whose identity this slave has, by their file's name.
[[nodiscard]] std::vector<std::string> profiles_of(const DriveOptions& options, const ecat::SurveyedSlave& slave);

}  // namespace taktwerk::apps
