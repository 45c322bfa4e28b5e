#pragma once
// Which kind of drive it is: by the machine file, by its identity, or as its user says.

#include <memory>
#include <string>
#include <vector>

#include "apps/drive/access.hpp"

namespace taktwerk::apps {

/// The profiles that a machine file, or the installation, knows.
[[nodiscard]] std::vector<std::shared_ptr<const axes::DriveProfile>> known_profiles(const DriveOptions& options);
/// By name among them. Error drive.no_profile names those that are there.
[[nodiscard]] Result<std::shared_ptr<const axes::DriveProfile>> profile_named(const DriveOptions& options, const std::string& name);

/// The kinds of drive whose identity this slave has, by their file's name.
[[nodiscard]] std::vector<std::string> profiles_of(const DriveOptions& options, const ecat::SurveyedSlave& slave);
/// --profile, else the machine file's, else the one whose identity the slave has. Error drive.no_profile.
[[nodiscard]] Result<std::shared_ptr<const axes::DriveProfile>> profile_of_slave(const DriveOptions& options, const ecat::Survey& survey,
                                                                                 std::size_t position);

}  // namespace taktwerk::apps
