#pragma once
// Who brought which version to run, and when: a line of JSON each, in audit.log beside the versions. Not real-time.

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// Who does something, and when.
struct Deed {
    std::string who;        ///< "joe (1000)"
    std::int64_t when = 0;  ///< seconds since 1970, UTC
};

struct AuditLine {
    std::string did;   ///< activate, roll back, fall back
    std::string from;  ///< a version; empty: none was active
    std::string to;
    std::string why{};  ///< of a fall back
};

/// On the disk when it returns. Errors: bundle.not_written.
[[nodiscard]] Result<void> write_audit(const std::filesystem::path& machine_folder, const Deed& deed, const AuditLine& line);

}  // namespace taktwerk::runtime
