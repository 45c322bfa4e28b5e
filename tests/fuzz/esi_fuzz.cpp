// Any bytes as a vendor's ESI file: an error with its place, or devices that can all be read, twice the same, and made an EEPROM of.
#include <cstdlib>

#include "ecat/esi/choose_device.hpp"
#include "ecat/esi/esi_file.hpp"
#include "ecat/esi/esi_sii.hpp"

using namespace taktwerk::ecat::esi;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 16384) return 0;
    const auto file = EsiFile::parse({reinterpret_cast<const std::byte*>(data), size}, "x.xml");
    if (!file) {
        if (file.error().what.empty() || file.error().subject.rfind("x.xml", 0) != 0) std::abort();
        return 0;
    }
    for (std::size_t n = 0; n < file->devices().size(); ++n) {
        const auto reading = file->read(n);
        for (const auto& problem : reading.problems)
            if (problem.subject.rfind("x.xml:", 0) != 0) std::abort();
        const auto again = file->read(n);
        if (again.device.objects.size() != reading.device.objects.size() || again.problems.size() != reading.problems.size()) std::abort();
        // An EEPROM made of it reads back, and what was read builds the same again.
        if (reading.device.eeprom && reading.device.eeprom->size > 65536) continue;
        const auto image = esi_image(reading.device).bytes;
        auto sii = taktwerk::ecat::parse_sii(image);
        sii.defects.clear();
        if (sii.strings.size() <= 255 && sii.size_code < 1024 && taktwerk::ecat::parse_sii(taktwerk::ecat::build_sii(sii)) != sii)
            std::abort();
    }
    (void)choose_device(*file, "", {});
    return 0;
}
