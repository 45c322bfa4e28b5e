#pragma once
// What a bundle says of itself: manifest.json, its first file. The signature is over its bytes, and its sums are over all other files. Not real-time.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// A program's library.
struct BundledProgram {
    std::string name;                     ///< as the machine file calls the program
    std::string path;                     ///< of its file in the bundle
    std::uint64_t abi = 0;                ///< programs/api/abi.hpp
    std::uint64_t interface_version = 0;  ///< program_interface_version of the SDK it was built with
    std::string sdk;                      ///< "0.1.0"
    std::string build_id{};               ///< GNU build id, hexadecimal; empty: it has none
};

struct BundledFile {
    std::string path;        ///< in the bundle, below files/
    std::string kind;        ///< machine, drive, device, program, cam, image
    std::uint64_t size = 0;  ///< bytes
    std::string sha256;      ///< 64 hexadecimal digits
};

struct Manifest {
    static constexpr std::uint64_t format = 1;
    std::string name;             ///< of the machine: is_bundle_name()
    std::string version;          ///< is_bundle_version()
    std::int64_t created = 0;     ///< seconds since 1970, UTC
    std::string minimum_runtime;  ///< "0.1.0": the version that checked it
    std::string target;           ///< runtime::this_target()
    std::string machine_file;     ///< path in the bundle; one of `files`
    std::vector<BundledProgram> programs;
    std::vector<BundledFile> files;  ///< in the order of the container
};

inline constexpr std::size_t longest_manifest = std::size_t{2} << 20;  ///< bytes
inline constexpr std::string_view manifest_path = "manifest.json", signature_path = "manifest.sig", files_folder = "files/";

/// A machine's name, as machine files have it: up to 40 letters, digits, `_` and `-`, a letter first.
[[nodiscard]] bool is_bundle_name(std::string_view text);
/// Up to 40 letters, digits and `._+-`, a letter or a digit first.
[[nodiscard]] bool is_bundle_version(std::string_view text);
/// "1.10.2" is not before "1.9": numbers with dots between. What is no number counts as 0.
[[nodiscard]] bool version_before(std::string_view a, std::string_view b);
/// "2026-11-26T05:12:00Z"
[[nodiscard]] std::string utc_text(std::int64_t seconds);

[[nodiscard]] std::string text_of(const Manifest& manifest);
/// Any text. Every path is one that a bundle may hold, every name and sum has its form, no file stands there twice, the machine file and the programs are
/// among the files. Errors: bundle.manifest; bundle.newer (of a later format).
[[nodiscard]] Result<Manifest> manifest_of(std::string_view text, const std::string& subject);

}  // namespace taktwerk::runtime
