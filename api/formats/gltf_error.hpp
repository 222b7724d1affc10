// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tinsmith::api {

/// Why a mesh cannot be written as glTF.
enum class EncodeFault {
    BadMesh,           ///< empty, a number not finite, an index out of range, a corner named twice
    BadOption,         ///< a tolerance or unit that is not a positive number
    ToleranceTooFine,  ///< float32 cannot hold this extent so exactly; `detail` has what it can
    TooLarge,          ///< more than the 4 GiB that a GLB can hold
    Codec,             ///< the Draco library refused: a defect of ours or its
};

/// One fault; `detail` says what the caller can do.
struct EncodeError {
    EncodeFault fault{};
    std::string detail;
};

}  // namespace tinsmith::api
