#pragma once
// The files of a machine, where they stand in a bundle: so that every word of the machine file means the same there, and nothing outside is needed.
//
//   machine/cell.yaml            the machine file, as it was
//   machine/build/feeder.so      what it names, by the same relative path: `library: build/feeder.so`
//   drives/xp200.yaml            the drive files that it uses, its own and the installed ones
//   devices/el1008.yaml          likewise
//
// A machine file that names `../../x` lies as much deeper (above/machine/cell.yaml). Not real-time.

#include <string>
#include <vector>

#include "config/machine_file/machine_loader.hpp"
#include "runtime/bundle/bundle_file.hpp"

namespace taktwerk::apps {

struct PackedMachine {
    std::string machine_file;                ///< path in the bundle
    std::vector<runtime::FileToPack> files;  ///< the machine file first, then by path

    /// The path in the bundle of a file that the machine file names so.
    [[nodiscard]] std::string place_of(const std::string& written) const;
};

/// Reads all of them. Errors: bundle.absolute (the file names a path of this computer alone), bundle.collision (two files would need one place),
/// bundle.unreadable.
[[nodiscard]] Result<PackedMachine> pack(const std::string& machine_file, const std::vector<config::UsedFile>& used);

}  // namespace taktwerk::apps
