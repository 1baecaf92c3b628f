"""How tests start chromium."""

# Without these a browser waits for a network, which a test does not need.
OFFLINE = ('--no-first-run', '--disable-background-networking', '--disable-component-update',
           '--disable-sync', '--disable-quic')
