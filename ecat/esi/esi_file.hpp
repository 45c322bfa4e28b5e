#pragma once
// One ESI file (ETG.2000): the vendor and his devices, each read in full when it is asked for. Total: any bytes in, an error or a device
// out. Not real-time.

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "ecat/esi/esi_device.hpp"

namespace taktwerk::ecat::esi {

/// A part of the file that nobody here reads, and how often it is there: "Device/Dc/OpMode/VendorSpecific".
struct Unread {
    std::string path;
    std::size_t count = 0;
    std::size_t line = 0;  ///< of the first
};

struct EsiReading {
    EsiDevice device;
    std::vector<Error> problems;  ///< the device cannot be used without what they are about (esi.number, esi.missing, ...)
    std::vector<Error> remarks;   ///< what was wrong in parts that it can do without: names, texts, the dictionary
    std::vector<Unread> unread;
};

class EsiFile {
public:
    /// `name` is what messages call it. Errors: esi.encoding, esi.xml, esi.not_esi, esi.too_large, esi.missing, esi.number.
    [[nodiscard]] static Result<EsiFile> parse(std::span<const std::byte> bytes, std::string name);
    /// Also: esi.file when it cannot be read.
    [[nodiscard]] static Result<EsiFile> open(const std::string& path);

    EsiFile(EsiFile&&) noexcept;
    EsiFile& operator=(EsiFile&&) noexcept;
    ~EsiFile();

    [[nodiscard]] const std::string& name() const noexcept;
    [[nodiscard]] const std::string& vendor_name() const noexcept;
    [[nodiscard]] std::uint32_t vendor() const noexcept;
    /// In the order of the file.
    [[nodiscard]] const std::vector<EsiHeading>& devices() const noexcept;
    /// Of the file as a whole: bytes of another encoding, devices whose identity is wrong, other files that it refers to.
    [[nodiscard]] const std::vector<Error>& remarks() const noexcept;
    /// The n-th of devices().
    [[nodiscard]] EsiReading read(std::size_t n) const;

private:
    struct Content;
    explicit EsiFile(std::unique_ptr<Content> content);
    std::unique_ptr<Content> content_;
};

}  // namespace taktwerk::ecat::esi
