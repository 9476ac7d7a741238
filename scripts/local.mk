# sessions to replay, developers tools
