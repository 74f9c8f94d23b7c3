# The programs of `make cpu` and the Python module, on Debian 12:
#   docker build -t raygate . && docker run --rm -v "$PWD:/here" -w /here raygate render MODEL.obj
FROM debian:12-slim
COPY . /raygate
WORKDIR /raygate
RUN apt-get update && apt-get install -y --no-install-recommends make && .ci/setup python && make cpu && python3 -m venv /opt/python && /opt/python/bin/pip install --no-cache-dir .
RUN for program in render trace merge; do ln -s "/raygate/build/$program" /usr/local/bin; done && \
    printf '#!/bin/sh\nexec /opt/python/bin/python3 "$@"\n' >/usr/local/bin/raygate-python && chmod +x /usr/local/bin/raygate-python
CMD ["render", "--help"]
