// Any bytes as a frame: every view stays inside it, and reader and editor agree.
#include <cstdlib>
#include <vector>

#include "ecat/wire/frame.hpp"

using namespace taktwerk::ecat;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::byte> frame(reinterpret_cast<const std::byte*>(data), reinterpret_cast<const std::byte*>(data) + size);
    FrameReader reader{std::span<const std::byte>{frame}};
    FrameEditor editor{frame};
    for (;;) {
        const auto read = reader.next();
        auto edited = editor.next();
        if (read.has_value() != edited.has_value() || reader.error() != editor.error()) std::abort();
        if (!read) return 0;
        if (read->header.data() < frame.data() || read->wkc.data() + read->wkc.size() > frame.data() + frame.size()) std::abort();
        for (auto& byte : edited->data) byte ^= std::byte{0xFF};
        edited->wkc[1] = std::byte{1};
    }
}
