#pragma once
// ESI files of our own making, written from the rules of ETG.2000.

#include <span>
#include <string>
#include <string_view>

#include "ecat/esi/esi_file.hpp"

namespace taktwerk::ecat::esi {

inline std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

/// A file of "Works" (vendor 9999 = 270Fh) around what stands in <Devices>, and what follows them in <Descriptions>.
inline std::string file_with(const std::string& devices, const std::string& behind = {}) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<EtherCATInfo Version=\"1.6\">\n<Vendor><Id>9999</Id><Name>Works</Name></Vendor>\n"
           "<Descriptions><Groups><Group><Type>Boxes</Type><Name LcId=\"1033\">Field boxes</Name></Group></Groups>\n<Devices>\n" +
           devices + "</Devices>\n" + behind + "</Descriptions>\n</EtherCATInfo>\n";
}

/// One device of type BX1, product 1001h, revision 20001h.
inline std::string device_with(const std::string& content) {
    return "<Device Physics=\"YY\">\n<Type ProductCode=\"#x1001\" RevisionNo=\"#x00020001\">BX1</Type>\n<Name>Box one</Name>\n" + content +
           "</Device>\n";
}

inline Result<EsiFile> parsed(const std::string& text) { return EsiFile::parse(bytes_of(text), "box.xml"); }

/// What a file with one device says of it.
inline EsiReading reading_of(const std::string& content, const std::string& behind = {}) {
    auto file = parsed(file_with(device_with(content), behind));
    if (!file || file->devices().size() != 1) return {};
    return file->read(0);
}

}  // namespace taktwerk::ecat::esi
