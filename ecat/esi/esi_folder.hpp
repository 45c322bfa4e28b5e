#pragma once
// A folder of vendors' files: who is the slave with this identity? Only headings are kept. Not real-time.

#include <optional>
#include <string>
#include <vector>

#include "ecat/esi/esi_file.hpp"

namespace taktwerk::ecat::esi {

/// A device of one of the files.
struct EsiKnown {
    std::string file, vendor;
    EsiHeading heading;
};

class EsiFolder {
public:
    /// Every *.xml in it, whatever the case of the ending, in the order of their names; not below it. Errors: esi.folder when there is no such
    /// folder or no ESI file in it.
    [[nodiscard]] static Result<EsiFolder> open(const std::string& path);

    /// Of the device with this vendor and product: the one with the same revision; else the newest of those before it whose low half, where
    /// variants differ, is the same; else the newest. nullptr: nobody describes it.
    [[nodiscard]] const EsiKnown* find(const Identity& identity) const noexcept;
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    [[nodiscard]] const std::vector<EsiKnown>& devices() const noexcept { return devices_; }
    /// Files that are damaged. What is XML of another kind is not worth a word.
    [[nodiscard]] const std::vector<Error>& damaged() const noexcept { return damaged_; }

private:
    std::string path_;
    std::vector<EsiKnown> devices_;
    std::vector<Error> damaged_;
};

}  // namespace taktwerk::ecat::esi
