#pragma once
// Why a program stopped by itself, in the words of what it threw. Fixed size: taken on the thread that caught it.

#include <exception>
#include <string_view>

#include "core/fixed_text.hpp"

namespace taktwerk::runtime {

class FaultText {
public:
    /// In a catch block only. No allocation: rethrows what is already there.
    void take_current() noexcept {
        try {
            throw;
        } catch (const std::exception& e) {
            text_ = std::string_view{e.what()};
        } catch (...) {
            text_ = std::string_view{"something that is no std::exception"};
        }
    }
    [[nodiscard]] std::string_view text() const noexcept { return text_.view(); }

private:
    FixedText<200> text_;
};

}  // namespace taktwerk::runtime
