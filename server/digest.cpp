// SPDX-License-Identifier: Apache-2.0
// The one file that knows OpenSSL.
#include "server/digest.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <new>

#include <openssl/evp.h>

namespace tinsmith::server {

std::string sha256_of(std::span<const std::string_view> parts) {
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(),
                                                                     EVP_MD_CTX_free);
    bool fine = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
    for (const std::string_view part : parts) {
        const auto size = static_cast<std::uint64_t>(part.size());
        fine = fine && EVP_DigestUpdate(context.get(), &size, sizeof size) == 1 &&
               EVP_DigestUpdate(context.get(), part.data(), part.size()) == 1;
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    fine = fine && EVP_DigestFinal_ex(context.get(), digest.data(), &size) == 1;
    if (!fine) throw std::bad_alloc();
    return {digest.begin(), digest.begin() + size};
}

}  // namespace tinsmith::server
