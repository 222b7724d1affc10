// SPDX-License-Identifier: Apache-2.0
#include "server/commands/complaints.hpp"

#include <iostream>
#include <limits>

namespace tinsmith::server {

void complain(const std::string& file, const api::Faults& faults) {
    const auto digits = std::cerr.precision(std::numeric_limits<double>::max_digits10);
    for (const api::Fault& fault : faults) {
        std::cerr << "tinsmith: " << file << ": ";
        if (!fault.pointer.empty()) std::cerr << fault.pointer << ": ";
        std::cerr << fault.code << ": " << fault.detail;
        if (fault.coordinate) {
            std::cerr << " (at " << (*fault.coordinate)[0] << ", " << (*fault.coordinate)[1] << ")";
        }
        std::cerr << "\n";
    }
    if (faults.size() >= api::kMaxFaults) std::cerr << "tinsmith: there may be more faults\n";
    std::cerr.precision(digits);
}

void complain(const std::string& text) {
    std::cerr << "tinsmith: " << text << "\n";
}

void tell_of(const std::string& file, const api::Terrain& terrain) {
    const std::string of_file = file + ": ";
    for (const std::string& note : terrain.notes)
        complain(of_file + note);
    if (!terrain.repairs) return;
    for (const core::Repair& repair : *terrain.repairs) {
        std::string text = of_file;
        text += "repaired: ";
        text += core::repair_name(repair.kind);
        text += ": ";
        text += std::to_string(repair.count);
        text += ':';
        for (const std::size_t index : repair.indices)
            text += ' ' + std::to_string(index);
        if (repair.count > repair.indices.size()) text += " ...";
        complain(text);
    }
}

}  // namespace tinsmith::server
