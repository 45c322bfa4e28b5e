#include "runtime/bundle/bundle_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <numeric>

#include <fmt/format.h>

#include "runtime/bundle/durable.hpp"
#include "runtime/signature/sha256.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

/// A bundle on the disk. One that shrinks while it is read is unreadable, nothing worse: it is never mapped.
class FileSource : public ByteSource {
public:
    FileSource(OwnedFd fd, std::uint64_t size, std::string path) : fd_(std::move(fd)), size_(size), path_(std::move(path)) {}
    [[nodiscard]] std::uint64_t size() const override { return size_; }
    [[nodiscard]] Result<void> read(std::uint64_t offset, std::span<std::byte> into) const override {
        while (!into.empty()) {
            const auto got = ::pread(fd_.get(), into.data(), into.size(), static_cast<off_t>(offset));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0)
                return Error{"bundle.unreadable", path_,
                             got < 0 ? fmt::format("it cannot be read: {}", std::strerror(errno))
                                     : std::string("it became shorter while it was read"),
                             "copy it again"};
            offset += static_cast<std::uint64_t>(got);
            into = into.subspan(static_cast<std::size_t>(got));
        }
        return {};
    }

private:
    OwnedFd fd_;
    std::uint64_t size_;
    std::string path_;
};

Error wrong_sum(const std::string& subject, const std::string& path) {
    return {"bundle.sum", subject, fmt::format("'{}' is not the file that the manifest names: its SHA-256 is another one", path),
            "copy the bundle again; if that changes nothing, somebody has changed it"};
}

}  // namespace

Result<BundleFile> BundleFile::open(const std::string& path, const Trust& trust) {
    OwnedFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    const auto unreadable = [&](std::string what) {
        return Error{"bundle.unreadable", path, std::move(what), "name a bundle: what `taktwerk bundle make` has written"};
    };
    if (!fd)
        return unreadable(errno == ENOENT ? std::string("there is no such file")
                                          : fmt::format("it cannot be read: {}", std::strerror(errno)));
    struct stat info {};
    if (::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode)) return unreadable("it is no file");
    return read(std::make_unique<FileSource>(std::move(fd), static_cast<std::uint64_t>(info.st_size), path), path, trust);
}

Result<BundleFile> BundleFile::read(std::unique_ptr<ByteSource> source, std::string subject, const Trust& trust) {
    BundleFile out(std::move(source), std::move(subject));
    auto container = read_container(*out.source_, out.subject_);
    if (!container) return container.error();
    out.container_ = std::move(container).value();
    const auto& files = out.container_.files;
    if (files.front().path != manifest_path || files.front().size > longest_manifest)
        return Error{"bundle.not_a_bundle", out.subject_, fmt::format("its first file is not {}", manifest_path),
                     "name what `taktwerk bundle make` has written"};
    auto text = out.text_at(files.front());
    if (!text) return text.error();
    out.manifest_text_ = std::move(text).value();
    if (files.size() > 1 && files[1].path == signature_path) {
        if (files[1].size != signature_size)
            return Error{"bundle.damaged", out.subject_,
                         fmt::format("its signature has {} bytes instead of {}", files[1].size, signature_size), "copy it again"};
        auto signature = out.text_at(files[1]);
        if (!signature) return signature.error();
        out.signature_ = std::move(signature).value();
    }
    auto signer = trust.judge(out.manifest_text_, out.signature_, out.subject_);
    if (!signer) return signer.error();
    out.signer_ = std::move(signer).value();
    auto manifest = manifest_of(out.manifest_text_, out.subject_);
    if (!manifest) return manifest.error();
    out.manifest_ = std::move(manifest).value();
    if (auto ok = out.match(); !ok) return ok.error();
    return out;
}

Result<void> BundleFile::match() const {
    const auto damaged = [&](std::string what) {
        return Error{"bundle.damaged", subject_, std::move(what), "copy it again; if that changes nothing, somebody has changed it"};
    };
    const std::size_t first = signature_ ? 2 : 1;
    const auto& packed = container_.files;
    if (container_.stamp != manifest_.created) return damaged("its files are stamped with another time than its manifest says");
    for (std::size_t i = 0; i < std::max(packed.size() - first, manifest_.files.size()); ++i) {
        if (i >= manifest_.files.size())
            return damaged(fmt::format("it holds '{}', which its manifest does not name", packed[first + i].path));
        const auto& listed = manifest_.files[i];
        const auto path = std::string(files_folder) + listed.path;
        if (first + i >= packed.size() || packed[first + i].path != path)
            return damaged(fmt::format("'{}' is missing, or not in its place", path));
        if (packed[first + i].size != listed.size)
            return damaged(fmt::format("'{}' has {} bytes, and its manifest says {}", path, packed[first + i].size, listed.size));
    }
    return {};
}

Result<std::string> BundleFile::text_at(const PackedFile& file) const {
    std::string text(file.size, '\0');
    if (auto ok = source_->read(file.offset, std::as_writable_bytes(std::span(text.data(), text.size()))); !ok) return ok.error();
    return text;
}

std::uint64_t BundleFile::bytes() const noexcept {
    return std::accumulate(manifest_.files.begin(), manifest_.files.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const BundledFile& file) { return sum + file.size; });
}

Result<std::string> BundleFile::content(const BundledFile& file) const {
    const auto path = std::string(files_folder) + file.path;
    for (const auto& packed : container_.files) {
        if (packed.path != path) continue;
        auto text = text_at(packed);
        if (text && hexadecimal(sha256_of(*text)) != file.sha256) return wrong_sum(subject_, file.path);
        return text;
    }
    return Error{"bundle.damaged", subject_, fmt::format("it holds no '{}'", file.path), "copy it again"};
}

Result<void> BundleFile::unpack(const fs::path& folder) const {
    if (auto ok = write_new_file(folder / manifest_path, manifest_text_); !ok) return ok;
    if (signature_)
        if (auto ok = write_new_file(folder / signature_path, *signature_); !ok) return ok;
    for (const auto& file : manifest_.files) {
        // One at a time: no more than one file of a bundle is ever in memory.
        const auto text = content(file);
        if (!text) return text.error();
        const auto place = folder / (std::string(files_folder) + file.path);
        if (auto ok = make_folders(place.parent_path()); !ok) return ok;
        if (auto ok = write_new_file(place, *text); !ok) return ok;
    }
    return sync_folders(folder);
}

fs::path UnpackedBundle::file(const std::string& path) const { return folder / (std::string(files_folder) + path); }
fs::path UnpackedBundle::machine_file() const { return file(manifest.machine_file); }

Result<UnpackedBundle> read_unpacked(const fs::path& folder) {
    UnpackedBundle out;
    out.folder = folder;
    auto text = read_small_file(folder / manifest_path, longest_manifest);
    if (!text) return text.error();
    auto manifest = manifest_of(*text, folder.string());
    if (!manifest) return manifest.error();
    out.manifest = std::move(manifest).value();
    out.manifest_text = std::move(text).value();
    std::error_code failed;
    if (fs::exists(folder / signature_path, failed)) {
        auto signature = read_small_file(folder / signature_path, signature_size);
        if (!signature) return signature.error();
        out.signature = std::move(signature).value();
    }
    return out;
}

Result<void> verify(const UnpackedBundle& bundle) {
    for (const auto& file : bundle.manifest.files) {
        const auto text = read_small_file(bundle.file(file.path), largest_packed_file);
        if (!text) return text.error();
        if (text->size() != file.size || hexadecimal(sha256_of(*text)) != file.sha256) {
            auto error = wrong_sum(bundle.folder.string(), file.path);
            error.remedy =
                fmt::format("`taktwerk bundle remove {} {}` and install it again", bundle.manifest.name, bundle.manifest.version);
            return error;
        }
    }
    return {};
}

Result<std::string> bundle_text(Manifest manifest, const std::vector<FileToPack>& files, const SecretKey* key) {
    manifest.files.clear();
    for (const auto& file : files) manifest.files.push_back({file.path, file.kind, file.bytes.size(), hexadecimal(sha256_of(file.bytes))});
    const auto text = text_of(manifest);
    ContainerText container(manifest.created);
    if (auto ok = container.add(std::string(manifest_path), text); !ok) return ok.error();
    if (key != nullptr)
        if (auto ok = container.add(std::string(signature_path), key->sign(text)); !ok) return ok.error();
    for (const auto& file : files)
        if (auto ok = container.add(std::string(files_folder) + file.path, file.bytes); !ok) return ok.error();
    return container.finish();
}

}  // namespace taktwerk::runtime
