#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Healthy when the server in this container answers /healthz with 200. Needs no HTTP client.
set -eu
exec 3<>"/dev/tcp/127.0.0.1/${TINSMITH_PORT:-8080}"
printf 'GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' >&3
read -r -t 5 _ status _ <&3
[[ $status == 200 ]]
