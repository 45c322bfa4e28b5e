#include "core/result.hpp"

namespace taktwerk {

std::string Error::text() const {
    std::string out;
    if (!subject.empty()) out += subject + ": ";
    out += what;
    if (!remedy.empty()) out += ". " + remedy;
    return out;
}

}  // namespace taktwerk
