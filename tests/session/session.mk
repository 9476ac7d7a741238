# scripts run by the real program
