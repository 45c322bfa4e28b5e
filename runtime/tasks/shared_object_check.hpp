#pragma once
// Is this file a shared object that dlopen can map? dlopen itself trusts the lengths in the file: a copy that was cut short ends
// the process with SIGBUS, and an object for another processor is called "No such file or directory". Not real-time.

#include <string>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// Reads the ELF headers of a regular file. Errors: unreadable, no ELF shared object of 64 bits, for another processor, cut short.
[[nodiscard]] Result<void> check_shared_object(const std::string& path);

/// The GNU build id that the linker gave it, hexadecimal; empty where it has none. Of a file that check_shared_object() takes.
[[nodiscard]] std::string build_id_of(const std::string& path);

}  // namespace taktwerk::runtime
