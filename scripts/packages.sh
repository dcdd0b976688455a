# shellcheck shell=sh
# Sourced by the other scripts: install_packages NAME... installs the Debian packages that are missing.

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null 2>&1; then
    sudo "$@"
  else
    echo "packages are missing ($missing): run this as root, or install sudo" >&2
    exit 1
  fi
}

# Names of its arguments that dpkg does not know as installed.
missing_packages() {
  for package in "$@"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || status=absent
    [ "$status" = installed ] || printf '%s ' "$package"
  done
}

install_packages() {
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  echo "installing: $missing"
  if [ -z "${package_lists_updated-}" ]; then
    as_root apt-get update -q
    package_lists_updated=yes
  fi
  # shellcheck disable=SC2086 # one word per package
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
}
