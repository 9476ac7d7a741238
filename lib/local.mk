# the public face: sessions
