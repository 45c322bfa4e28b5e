#pragma once
// A bundle as a file, or as a folder that one was unpacked into. What it says is looked at in this order: the container, the signature over the manifest, the
// manifest, and each file against its sum when it is unpacked. Not real-time. Any bytes may be given.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "runtime/bundle/container.hpp"
#include "runtime/bundle/manifest.hpp"
#include "runtime/bundle/trust.hpp"
#include "runtime/signature/signing_key.hpp"

namespace taktwerk::runtime {

class BundleFile {
public:
    /// Errors: bundle.unreadable, those of read_container(), Trust::judge() and manifest_of(), bundle.damaged (its files are not those that its manifest
    /// lists).
    [[nodiscard]] static Result<BundleFile> open(const std::string& path, const Trust& trust);
    [[nodiscard]] static Result<BundleFile> read(std::unique_ptr<ByteSource> source, std::string subject, const Trust& trust);

    [[nodiscard]] const Manifest& manifest() const noexcept { return manifest_; }
    [[nodiscard]] const std::string& manifest_text() const noexcept { return manifest_text_; }
    [[nodiscard]] const std::optional<std::string>& signature() const noexcept { return signature_; }
    [[nodiscard]] const Signer& signer() const noexcept { return signer_; }
    /// Of everything, unpacked.
    [[nodiscard]] std::uint64_t bytes() const noexcept;
    /// One file, if its sum is right. Errors: bundle.sum, bundle.unreadable.
    [[nodiscard]] Result<std::string> content(const BundledFile& file) const;
    /// Everything, into a folder that is there and empty, each file on the disk before the next. What was written when an error comes stays there.
    /// Errors: bundle.sum (a file is not the one that the manifest names), bundle.not_written, bundle.unreadable.
    [[nodiscard]] Result<void> unpack(const std::filesystem::path& folder) const;

private:
    BundleFile(std::unique_ptr<ByteSource> source, std::string subject) : source_(std::move(source)), subject_(std::move(subject)) {}
    [[nodiscard]] Result<std::string> text_at(const PackedFile& file) const;
    [[nodiscard]] Result<void> match() const;

    std::unique_ptr<ByteSource> source_;
    std::string subject_;
    Container container_;
    std::string manifest_text_;
    std::optional<std::string> signature_;
    Signer signer_;
    Manifest manifest_;
};

/// A bundle that was unpacked into `folder`.
struct UnpackedBundle {
    std::filesystem::path folder;
    Manifest manifest;
    std::string manifest_text;
    std::optional<std::string> signature;
    [[nodiscard]] std::filesystem::path machine_file() const;
    [[nodiscard]] std::filesystem::path file(const std::string& path) const;
};

/// What stands in it, without looking at its files. Errors: bundle.unreadable, those of manifest_of().
[[nodiscard]] Result<UnpackedBundle> read_unpacked(const std::filesystem::path& folder);
/// Whether its files are those that were packed. Errors: bundle.sum, bundle.unreadable.
[[nodiscard]] Result<void> verify(const UnpackedBundle& bundle);

/// A file that goes into a bundle.
struct FileToPack {
    std::string path;  ///< in the bundle
    std::string kind;
    std::string bytes;
};
/// The text of a whole bundle; `manifest.files` is filled in. `key` may be nullptr: nobody signs it. Errors: those of ContainerText.
[[nodiscard]] Result<std::string> bundle_text(Manifest manifest, const std::vector<FileToPack>& files, const SecretKey* key);

}  // namespace taktwerk::runtime
