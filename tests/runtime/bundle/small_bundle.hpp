#pragma once
// A bundle of a few bytes, without a machine, and a folder that is gone with the test.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stdlib.h>

#include "runtime/bundle/audit.hpp"
#include "runtime/bundle/bundle_file.hpp"
#include "runtime/bundle/target.hpp"

namespace taktwerk::runtime {

class BundleText : public ByteSource {
public:
    explicit BundleText(std::string text) : text_(std::move(text)) {}
    [[nodiscard]] std::uint64_t size() const override { return text_.size(); }
    [[nodiscard]] Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override {
        if (offset > text_.size() || into.size() > text_.size() - offset) ADD_FAILURE() << "read behind the end";
        else
            std::copy_n(std::as_bytes(std::span(text_.data(), text_.size())).begin() + static_cast<std::ptrdiff_t>(offset), into.size(),
                        into.begin());
        return {};
    }

private:
    std::string text_;
};

class TemporaryFolder {
public:
    TemporaryFolder() {
        // In memory, where there is such a folder: what is synchronised again and again shall not wait for a disk.
        const std::filesystem::path memory = "/dev/shm";
        auto name =
            ((std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) / "taktwerk_bundle_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path_ / name, std::ios::binary) << text;
        return (path_ / name).string();
    }

private:
    std::filesystem::path path_;
};

inline std::string text_of_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The computer that small bundles are for.
inline Host small_host() { return {"linux-test", "0.2.0", 0x1122334455667788, 8}; }

/// 2026-11-26T05:12:00Z: 20 783 days after 1970-01-01, and 18 720 s.
inline constexpr std::int64_t small_time = 20'783LL * 86'400 + 18'720;

inline const Deed joe{"joe (1000)", small_time};

inline Manifest small_manifest(const std::string& version = "1.0", const std::string& name = "cell") {
    Manifest manifest;
    manifest.name = name;
    manifest.version = version;
    manifest.created = small_time;
    manifest.minimum_runtime = "0.1.0";
    manifest.target = small_host().target;
    manifest.machine_file = "machine/cell.yaml";
    manifest.programs = {{"feeder", "machine/feeder.so", small_host().abi, 8, "0.1.0", "00ff"}};
    return manifest;
}

inline std::vector<FileToPack> small_files(const std::string& machine = "name: cell\n") {
    return {{"machine/cell.yaml", "machine", machine},
            {"machine/feeder.so", "program", std::string(700, '\x7f')},
            {"drives/any.yaml", "drive", ""}};
}

inline std::string small_bundle(const Manifest& manifest = small_manifest(), const SecretKey* key = nullptr) {
    auto text = bundle_text(manifest, small_files("name: cell # " + manifest.version + "\n"), key);
    return text ? *text : text.error().text();
}

inline SecretKey new_key() { return std::move(SecretKey::make()).value(); }
inline Trust trust_in(const SecretKey& key) { return Trust({{"plant", key.public_half()}}, "keys"); }
inline Trust nobody() { return Trust({}); }

}  // namespace taktwerk::runtime
